// Flies a module as any caller would: only by its manifest.
//   node wasm_flight.mjs MODULE MANIFEST JOBS OUT
// JOBS: JSON, a list of {numbers: {key: value}, steps, every, repeat}. OUT gets the rows of all logs as float64; one
// line of JSON a job goes to stdout: {ready_ms, guard, reached, ns_per_step}.
import { readFileSync, writeFileSync } from "node:fs";

const [modulePath, manifestPath, jobsPath, out] = process.argv.slice(2);
const manifest = JSON.parse(readFileSync(manifestPath, "utf8"));
const began = performance.now();
const { exports } = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(modulePath)));
const ready = performance.now() - began;
const { memory } = exports;
const { words } = manifest.context;
const sizes = manifest.sizes;
const TABLES = { pushes: "push_count", gusts: "gust_count", walls: "wall_count", legs: "leg_count" };

function rooms(counts) {
  const places = {};
  let at = exports.__heap_base.value;
  for (const [name, count] of Object.entries(counts)) {
    places[name] = at;
    at += Math.ceil((8 * count) / 64) * 64 + 64;
  }
  const missing = at - memory.buffer.byteLength;
  if (missing > 0) memory.grow(Math.ceil(missing / 65536));
  new Uint8Array(memory.buffer, exports.__heap_base.value, at - exports.__heap_base.value).fill(0);
  return places;
}

const doubles = (at, count) => new Float64Array(memory.buffer, at, count);
const integers = (at, count) => new BigInt64Array(memory.buffer, at, count);

function fly({ numbers = {}, steps = manifest.steps, every = manifest.every }) {
  const rows = Math.floor(steps / every) + 1;
  const { ring_rows: rings, ring_row: row } = sizes;
  const at = rooms({
    context: words.length,
    numbers: manifest.numbers.length,
    prepared: sizes.prepared,
    work: Math.max(sizes.work, sizes.prepare_work),
    ring: rings * row,
    delays: manifest.delays.length,
    keys: 2,
    log: rows * sizes.sample,
    last: sizes.sample,
  });
  const given = manifest.numbers.map(({ key, value }) => Number(numbers[key] ?? value));
  doubles(at.numbers, given.length).set(given);
  const guard = Number(exports.prepare(at.numbers, at.prepared, at.work));
  if (guard) return { guard, reached: 0, rows, log: doubles(at.log, rows * sizes.sample) };
  doubles(at.work, sizes.work).fill(0);
  const flight = doubles(at.prepared, sizes.flight);
  const start = manifest.delayed.flatMap(([first, count]) => [...flight.subarray(first, first + count)]);
  for (let i = 0; i < rings && row; i++) doubles(at.ring + 8 * i * row, row).set(start);
  integers(at.delays, manifest.delays.length).set(manifest.delays.map(BigInt));
  doubles(at.keys, 2).set(manifest.keys);
  const put = (word, value) => {
    integers(at.context, words.length)[words.indexOf(word)] = BigInt(value);
  };
  for (const name of ["work", "ring", "delays", "keys", "log", "last"]) put(name, at[name]);
  put("flight", at.prepared);
  for (const [name, count] of Object.entries(TABLES)) {
    put(name, at.prepared + 8 * manifest.prepared[name][0]);
    put(count, manifest.prepared[name][1]);
  }
  const settings = { rings, stride: rows * sizes.sample, steps, every, fresh: 1, stop: steps + 1 };
  for (const [word, value] of Object.entries(settings)) put(word, value);
  doubles(at.context, words.length)[words.indexOf("dt")] = manifest.dt;
  const before = process.cpuUsage();
  const reached = Number(exports.fly(at.context));
  const { user, system } = process.cpuUsage(before);
  return { guard, reached, ns: ((user + system) * 1e3) / steps, log: doubles(at.log, rows * sizes.sample) };
}

const logs = [];
for (const job of JSON.parse(readFileSync(jobsPath, "utf8"))) {
  const { guard, reached, log } = fly(job);
  logs.push(Buffer.from(log.slice().buffer));
  let fastest = Infinity;
  for (let i = 0; i < (job.repeat ?? 0); i++) {
    fastest = Math.min(fastest, fly({ ...job, every: (job.steps ?? manifest.steps) + 1 }).ns);
  }
  console.log(JSON.stringify({ ready_ms: ready, guard, reached, ns_per_step: Number.isFinite(fastest) ? fastest : 0 }));
}
writeFileSync(out, Buffer.concat(logs));
