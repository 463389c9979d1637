import assert from "node:assert/strict";
import { test } from "node:test";

import { History } from "../src/ui/history.ts";
import { FrameRate } from "../src/view/graphics.ts";
import { isStill } from "../src/view/rest.ts";
import { Frame, Layout } from "../src/wire/frames.ts";
import type { FrameFieldName } from "../src/wire/messages.generated.ts";
import type { FlownScene } from "../src/wire/source.ts";

const FIELDS: [FrameFieldName, number][] = [["time", 1], ["position", 3], ["attitude", 4], ["push", 3], ["held", 1], ["phase", 1]];
const LAYOUT = new Layout(FIELDS);

function frame(time: number, x = 0, push = 0, held = 0, phase = 0): Frame {
  return new Frame(LAYOUT, Float32Array.from([time, x, 0, 1, 1, 0, 0, 0, push, 0, 0, held, phase]));
}

test("a vehicle stands still to the eye unless it moves, is held or pushed, or its phase changes", () => {
  assert.ok(isStill(frame(2, 0.002), frame(1)));
  for (const other of [frame(2, 0.02), frame(2, 0, 0.1), frame(2, 0, 0, 1), frame(2, 0, 0, 0, 1)]) {
    assert.ok(!isStill(other, frame(1)));
  }
});

test("a page was at rest in a second only if no picture of it was due", () => {
  const rate = new FrameRate();
  for (const now of [1000, 1500, 2000]) rate.tick(now, true, true);
  assert.equal(rate.rate, null);
  for (let now = 2050; now <= 3000; now += 50) rate.tick(now, now % 100 === 0, now % 100 !== 0);
  assert.equal(rate.rate, 10);
});

test("an hour is kept in the memory of a quarter of an hour, the last minutes of it whole", () => {
  const scene = { vehicle: { quadrotors: [] }, mission: "hover", fields: FIELDS } as unknown as FlownScene;
  const history = new History(scene);
  for (let i = 0; i <= 20 * 3600; i++) history.add(frame(i / 20, i));
  history.show([0, 3600]);
  const times = history.column("time");
  assert.ok(times.length <= 16_384);
  assert.deepEqual([times[0], times[times.length - 1]], [0, 3600]);
  assert.ok(times.every((time, i) => i === 0 || time > times[i - 1]));
  assert.deepEqual(Array.from(history.column("position0").slice(-2000)), Array.from(times.slice(-2000), (t) => Math.round(20 * t)));
});
