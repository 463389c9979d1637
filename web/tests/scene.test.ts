import assert from "node:assert/strict";
import { test } from "node:test";

import { bladeFrequency } from "../src/ui/rotor_sound.ts";
import { pushText, thresholdAlong } from "../src/view/push.ts";

test("a push reaches the threshold where the first of its axes does", () => {
  assert.ok(Math.abs(thresholdAlong([3, 4, 0], [0.3, 0.8, 0.1]) - 0.5) < 1e-12); // 0.1 times the push: x at its limit
  assert.equal(thresholdAlong([0, 0, -2], [0.3, 0.3, 0.7]), 0.7);
});

test("two blades pass twice a turn", () => {
  const [most, fastest] = [5.84e-6 * 1100 ** 2, 1100]; // the iris
  assert.ok(Math.abs(bladeFrequency(most, most, fastest) - 2 * (1100 / (2 * Math.PI))) < 1e-9);
  assert.ok(Math.abs(bladeFrequency(most / 4, most, fastest) - 1100 / (2 * Math.PI)) < 1e-9);
  assert.equal(bladeFrequency(-1, most, fastest), 0);
});

test("a push below the threshold is told with the threshold of the settings, along the axis that is nearest to it", () => {
  assert.equal(pushText([0.27, -0.2, 0], [0.4217, 0.4217, 0.4217]), "0.27 of 0.42 N along x");
  assert.equal(pushText([0.27, -0.2, 0], [0.4217, 0.25, 0.4217]), "0.20 of 0.25 N along y");
  assert.equal(pushText([0.3, 0.4, 0], [0.39, 0.39, 0.39]), "0.50 N"); // y passes it
});
