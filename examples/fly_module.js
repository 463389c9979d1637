// Flies a module of `tandemlift compile MISSION --target wasm32` by its manifest alone, in Node.js or in a browser.
//
//   import "./fly_module.js";
//   const { log } = flyModule(bytes, manifest, { numbers: { "vehicle.payload.mass": 0.6 } });
//
// numbers: those of the mission that differ, by key; steps and every: of the flight, by default the mission's.
// Returns the guard of the mission that failed (0 for none), the step reached, the time spent in the flight [ms], and
// the log, rows of manifest.sizes.sample numbers; manifest.channels says what they are.
globalThis.flyModule = (bytes, manifest, { numbers = {}, steps = manifest.steps, every = manifest.every } = {}) => {
  const { exports } = new WebAssembly.Instance(new WebAssembly.Module(bytes));
  const { sizes, context, prepared, delayed, delays, keys } = manifest;
  const rows = Math.floor(steps / every) + 1;
  const doubles = (at, count) => new Float64Array(exports.memory.buffer, at, count);
  const integers = (at, count) => new BigInt64Array(exports.memory.buffer, at, count);

  // memory, from the heap of the module on
  const counts = {
    context: context.words.length,
    numbers: manifest.numbers.length,
    prepared: sizes.prepared,
    work: Math.max(sizes.work, sizes.prepare_work),
    ring: sizes.ring_rows * sizes.ring_row,
    delays: delays.length,
    keys: keys.length,
    log: rows * sizes.sample,
    last: sizes.sample,
  };
  const at = {};
  let end = exports.__heap_base.value;
  for (const [name, count] of Object.entries(counts)) {
    at[name] = end;
    end += 64 * Math.ceil(count / 8 + 1);
  }
  exports.memory.grow(Math.max(0, Math.ceil((end - exports.memory.buffer.byteLength) / 65536)));

  // the mission's numbers become the flight's
  doubles(at.numbers, counts.numbers).set(manifest.numbers.map(({ key, value }) => Number(numbers[key] ?? value)));
  const guard = Number(exports.prepare(at.numbers, at.prepared, at.work));
  if (guard) return { guard, reached: 0, spent: 0, log: doubles(at.log, counts.log).slice() };
  doubles(at.work, counts.work).fill(0);

  // every row of the delay lines begins with what is delayed
  const flight = doubles(at.prepared, sizes.flight);
  const row = delayed.flatMap(([first, count]) => [...flight.subarray(first, first + count)]);
  for (let i = 0; i < sizes.ring_rows; i++) doubles(at.ring, counts.ring).set(row, i * sizes.ring_row);
  integers(at.delays, counts.delays).set(delays.map(BigInt));
  doubles(at.keys, counts.keys).set(keys);

  // the context: addresses, counts, and the grid of time
  const words = { ...at, flight: at.prepared, rings: sizes.ring_rows, stride: rows * sizes.sample };
  Object.assign(words, { steps, every, fresh: 1, stop: steps + 1 });
  const tables = { pushes: "push_count", gusts: "gust_count", walls: "wall_count", legs: "leg_count" };
  for (const [name, count] of Object.entries(tables)) {
    words[name] = at.prepared + 8 * prepared[name][0];
    words[count] = prepared[name][1];
  }
  integers(at.context, counts.context).set(context.words.map((word) => BigInt(words[word] ?? 0)));
  doubles(at.context, counts.context)[context.words.indexOf("dt")] = manifest.dt;

  const began = performance.now();
  const reached = Number(exports.fly(at.context));
  return { guard, reached, spent: performance.now() - began, log: doubles(at.log, counts.log).slice() };
};
