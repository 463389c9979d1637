// node wasm_flight.mjs MODULE MANIFEST JOBS OUT: flies jobs of a module. JOBS: JSON, a list of {numbers, steps, every}.
// OUT gets the logs, one after another; one line of JSON a job goes to stdout: {guard, reached}.
import { readFileSync, writeFileSync } from "node:fs";

import "../../examples/fly_module.js";

const [module, manifest, jobs, out] = process.argv.slice(2);
const read = (path) => JSON.parse(readFileSync(path, "utf8"));
const flown = read(jobs).map((job) => globalThis.flyModule(readFileSync(module), read(manifest), job));
for (const { guard, reached } of flown) console.log(JSON.stringify({ guard, reached }));
writeFileSync(out, Buffer.concat(flown.map(({ log }) => Buffer.from(log.buffer))));
