import assert from "node:assert/strict";
import { test } from "node:test";

import type { HandOptions } from "../src/hand/options.ts";
import { handKinds } from "../src/ui/hand_rows.ts";
import { takenBy } from "../src/ui/status_bar.ts";
import { Frame, Layout } from "../src/wire/frames.ts";
import { fake } from "./dom.ts";

const AUTHORITY = [8, 30, 20, 4, 2, 1]; // N across, up, down; N m

function pushed(force: number[], moment: number[]): number {
  const layout = new Layout([["push", 3], ["push_moment", 3]]);
  return takenBy(new Frame(layout, Float32Array.from([...force, ...moment])), AUTHORITY);
}

test("a hand takes the largest share of force across, up or down and of the moments", () => {
  assert.equal(pushed([0, 0, 0], [0, 0, 0]), 0);
  assert.equal(pushed([3, -4, 0], [0, 0, 0]), 5 / 8);
  assert.equal(pushed([0, 0, 15], [0, 0, 0]), 15 / 30);
  assert.equal(pushed([0, 0, -15], [0, 0, 0]), 15 / 20);
  assert.equal(pushed([1, 0, 0], [-1, 0, 0.5]), 0.5);
  assert.equal(pushed([1, 0, 0], [-1, -1.5, 0.5]), 0.75);
  assert.equal(pushed([0, 0, 0], [0, 0, 2]), 2);
});

test("the frequency is asked for where the hand shakes, and only there", () => {
  const options: HandOptions = { at: "point", plane: "facing", kind: "push", frequency: 4, force: 3, directions: "view" };
  const [kinds, slider] = handKinds(options).map(fake);
  const [push, shake, tap] = kinds.children;
  assert.ok(slider.attributes.has("hidden"));
  for (const [button, kind] of [[shake, "shake"], [tap, "tap"], [push, "push"]] as const) {
    button.click();
    assert.equal(options.kind, kind);
    assert.equal(slider["hidden"], kind !== "shake");
  }
  const [range, shown] = slider.children;
  Object.assign(range, { valueAsNumber: 7.5 }).event("input");
  assert.deepEqual([options.frequency, shown.textContent], [7.5, "7.5 Hz"]);
});
