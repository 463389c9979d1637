// Flies a page's flight in Node.js as a test says, and tells what came of it. One JSON object a line, both ways:
//
//   {"say": message} → answers or a refusal        {"fly": steps} → steps flown
//   {"look": 1} → frame, status, sample            {"link": settings} → refusals
//   {"scene": 1} → the scene                       {"save": file, "name": name} → the file is written

import { readFileSync, writeFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { gunzipSync } from "node:zlib";

import type { FlightIndex, MissionEntry } from "../../web/src/flight/manifest.ts";
import { unpacked } from "../../web/src/flight/manifest.ts";
import { FlightModule } from "../../web/src/flight/module.ts";
import { Refusal } from "../../web/src/flight/refusal.ts";
import { Session } from "../../web/src/flight/session.ts";

const [file, sha256, version] = process.argv.slice(2);
const [manifest, code] = unpacked(
  new Uint8Array(gunzipSync(readFileSync(file))),
  { sha256 } as MissionEntry,
  { version, broken: "broken", other_version: "of another version" } as FlightIndex,
);
const session = new Session(new FlightModule(new WebAssembly.Module(code), manifest.module), manifest, () => 0);

interface Request {
  say?: Parameters<Session["apply"]>[0];
  fly?: number;
  look?: number;
  scene?: number;
  link?: Parameters<Session["take"]>[0];
  save?: string;
  name?: string;
}

function done(request: Request): unknown {
  if (request.say) return session.apply(request.say, 1);
  if (request.fly !== undefined) return session.fly(request.fly);
  if (request.link) return session.take(request.link);
  if (request.scene) return session.scene;
  if (request.save) {
    const [saved] = session.apply({ type: "save", name: request.name! }, 1);
    if (saved.type === "saved") writeFileSync(request.save, saved.bytes);
    return saved.type;
  }
  const sample = Buffer.from((session as unknown as { flight: { sample: Float64Array } }).flight.sample.slice().buffer);
  const frame = Buffer.from(session.frame().buffer);
  return { status: session.status(), frame: frame.toString("hex"), sample: sample.toString("hex") };
}

createInterface({ input: process.stdin }).on("line", (line) => {
  let answer: unknown;
  try {
    answer = { did: done(JSON.parse(line) as Request) };
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    answer = { refused: error.message };
  }
  process.stdout.write(`${JSON.stringify(answer)}\n`);
});
