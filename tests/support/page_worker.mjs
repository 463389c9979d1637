// Runs the page's worker, as it ships, in Node.js with a clock that the tests set: node page_worker.mjs worker.js
//
// One JSON object a line: {"fly": steps}, {"settle": 1}, or a message for the worker. After each, what the worker said
// since, as one line; bytes and float32 numbers in hexadecimal.

import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import vm from "node:vm";

const said = [];
let now = 0; // ms
let waiting = []; // what the worker's timers call

const self = {
  postMessage: (message) => said.push(message),
  onmessage: null,
};
class Channel {
  port1 = { onmessage: null };
  port2 = { postMessage: () => waiting.push(() => this.port1.onmessage()) };
}
const context = vm.createContext({
  self,
  console,
  performance: { now: () => now },
  setTimeout: (call) => waiting.push(call),
  MessageChannel: Channel,
  ...{ WebAssembly, DecompressionStream, Blob, Response, TextDecoder, TextEncoder, atob, structuredClone },
});
vm.runInContext(readFileSync(process.argv[2], "utf8"), context);

function turn() {
  const calls = waiting;
  waiting = [];
  for (const call of calls) call();
}

/** Lets time pass; the worker looks at the clock after every step. */
function fly(steps, dt) {
  if (now === 0) now = 500 * dt; // half a step: what is due is never at the edge of a step
  for (let i = 0; i < steps; i++) {
    now += 1000 * dt;
    turn();
  }
}

const hex = (key, value) =>
  value?.buffer && value.byteLength !== undefined ? Buffer.from(value.buffer, value.byteOffset, value.byteLength).toString("hex") : value;

async function handle(line) {
  const request = JSON.parse(line);
  if (request.fly !== undefined) fly(request.fly, request.dt);
  else self.onmessage({ data: request });
  while (["open", "along"].includes(request.type) && !said.length) await new Promise((done) => setTimeout(done, 1));
  process.stdout.write(`${JSON.stringify(said.splice(0), hex)}\n`);
}

for await (const line of createInterface({ input: process.stdin })) await handle(line);
