import assert from "node:assert/strict";
import { test } from "node:test";

import {
  depthAfterWheel,
  levelDirections,
  meetLevelPlane,
  meetPlane,
  nearestToRay,
  type Ray,
  toBody,
  toWorld,
} from "../src/math/vectors.ts";
import type { Quaternion, Vector } from "../src/wire/messages.generated.ts";

const near = (a: Vector, b: Vector): boolean => a.every((value, i) => Math.abs(value - b[i]) < 1e-9);
const quarter: Quaternion = [Math.SQRT1_2, 0, 0, Math.SQRT1_2]; // about z

test("a quarter turn about z takes x to y, and back", () => {
  assert.ok(near(toWorld(quarter, [1, 0, 0]), [0, 1, 0]));
  assert.ok(near(toBody(quarter, [0, 1, 0]), [1, 0, 0]));
});

test("a ray finds the point of the beam that it passes", () => {
  const ray: Ray = { origin: [-5, 0.4, 0.1], direction: [1, 0, 0] };
  const found = nearestToRay(ray, [0, -1, 0], [0, 1, 0]);
  assert.ok(near(found.point, [0, 0.4, 0]));
  assert.ok(Math.abs(found.gap - 0.1) < 1e-9);
  assert.ok(Math.abs(found.depth - 5) < 1e-9);
});

test("beyond the end of the beam its end is the nearest", () => {
  const found = nearestToRay({ origin: [-5, 3, 0], direction: [1, 0, 0] }, [0, -1, 0], [0, 1, 0]);
  assert.ok(near(found.point, [0, 1, 0]));
  assert.ok(Math.abs(found.gap - 2) < 1e-9);
});

test("a beam behind the eye is as far as the eye is from it", () => {
  const found = nearestToRay({ origin: [5, 0, 0], direction: [1, 0, 0] }, [0, -1, 0], [0, 1, 0]);
  assert.equal(found.depth, 0);
  assert.ok(Math.abs(found.gap - 5) < 1e-9);
});

test("along the beam, any of its points will do", () => {
  const found = nearestToRay({ origin: [0, -9, 0], direction: [0, 1, 0] }, [0, -1, 0], [0, 1, 0]);
  assert.ok(found.gap < 1e-9);
});

test("a payload without length can be taken hold of too", () => {
  const found = nearestToRay({ origin: [-2, 0, 0.5], direction: [1, 0, 0] }, [0, 0, 0], [0, 0, 0]);
  assert.ok(near(found.point, [0, 0, 0]));
  assert.ok(Math.abs(found.gap - 0.5) < 1e-9);
});

test("a drag stays at its depth wherever the cursor is", () => {
  const direction: Vector = [0.8, 0.6, 0];
  const hit = meetPlane({ origin: [1, 0, 0], direction }, [1, 0, 0], 4)!;
  assert.ok(near(hit, [5, 3, 0]));
});

test("a level plane is met at its height, in front of the eye and not too far", () => {
  const ray: Ray = { origin: [0, 0, 3], direction: [0.6, 0, -0.8] };
  assert.ok(near(meetLevelPlane(ray, 1, 40)!, [1.5, 0, 1]));
  assert.equal(meetLevelPlane(ray, 4, 40), null);
  assert.equal(meetLevelPlane({ origin: [0, 0, 3], direction: [1, 0, 0] }, 1, 40), null);
  assert.equal(meetLevelPlane({ origin: [0, 0, 3], direction: [0.9999, 0, -0.0141] }, 1, 40), null);
});

test("a ray along the plane meets it nowhere", () => {
  assert.equal(meetPlane({ origin: [0, 0, 0], direction: [0, 1, 0] }, [1, 0, 0], 4), null);
});

test("the wheel turned back brings the hand back, and never through the eye", () => {
  assert.ok(Math.abs(depthAfterWheel(depthAfterWheel(3, 100), -100) - 3) < 1e-9);
  assert.ok(depthAfterWheel(3, -100) > 3);
  assert.ok(depthAfterWheel(0.31, 300) >= 0.3);
});

test("keys push level as one looks; from straight above, up is the picture's up", () => {
  const [forward, left] = levelDirections([0.6, 0, -0.8], [0.8, 0, 0.6]);
  assert.ok(near(forward, [1, 0, 0]));
  assert.ok(near(left, [0, 1, 0]));
  assert.ok(near(levelDirections([0, 0, -1], [0, 1, 0])[0], [0, 1, 0]));
});
