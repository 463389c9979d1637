import assert from "node:assert/strict";
import { test } from "node:test";

import type { Frame } from "../src/wire/frames.ts";
import type { FlightScene, FrameFieldName, StatusMessage } from "../src/wire/messages.generated.ts";
import { bytes, Replay } from "../src/wire/replay.ts";
import type { FlightListener } from "../src/wire/source.ts";

const fields: [FrameFieldName, number][] = [
  ["time", 1],
  ["position", 3],
  ["phase", 1],
];
const scene = { fields, phases: ["idle", "guided"], alarms: [""] } as unknown as FlightScene;
const flight = (): Replay =>
  new Replay({ ...scene }, Float32Array.from([10, 0, 0, 0, 0, 11, 1, 0, 0, 1, 12, 4, 0, 0, 1]));

function watched(recorded: Replay): { frame: () => Frame; status: () => StatusMessage } {
  let [frame, status]: [Frame | null, StatusMessage | null] = [null, null];
  const nothing = (): void => undefined;
  const listener: FlightListener = {
    scene: nothing,
    frame: (one) => (frame = one),
    status: (one) => (status = one),
    changed: nothing,
    refused: nothing,
    done: nothing,
    disconnected: nothing,
    connected: nothing,
  };
  recorded.start(listener);
  return { frame: () => frame!, status: () => status! };
}

test("a replay begins at its beginning and says in which phase it is", () => {
  const seen = watched(flight());
  assert.equal(seen.frame().scalar("time"), 10);
  assert.equal(seen.status().phase, "idle");
});

test("one can go to any time, between frames and past the ends", () => {
  const recorded = flight();
  const seen = watched(recorded);
  recorded.seek(11.5);
  assert.equal(seen.frame().vector("position")[0], 2.5);
  assert.equal(seen.status().phase, "guided");
  recorded.seek(99);
  assert.equal(seen.frame().vector("position")[0], 4);
  recorded.seek(-1);
  assert.equal(seen.frame().scalar("time"), 10);
});

test("time passes at the pace that was set, and stops at the end", () => {
  const recorded = flight();
  const seen = watched(recorded);
  recorded.setSpeed(2);
  recorded.tick(1000);
  recorded.tick(1100);
  assert.ok(Math.abs(seen.frame().scalar("time") - 10.2) < 1e-5);
  for (let now = 1200; now < 4000; now += 100) recorded.tick(now);
  assert.equal(seen.frame().scalar("time"), 12);
  assert.equal(recorded.playing, false);
  recorded.play(true);
  assert.equal(seen.frame().scalar("time"), 10);
});

test("base64 holds the bytes that were put in", () => {
  assert.deepEqual([...new Uint8Array(bytes(Buffer.from([0, 128, 255]).toString("base64")))], [0, 128, 255]);
});
