import assert from "node:assert/strict";
import { test } from "node:test";

import { between, Frame, Layout } from "../src/wire/frames.ts";
import type { FrameFieldName } from "../src/wire/messages.generated.ts";

const FIELDS: [FrameFieldName, number][] = [
  ["time", 1],
  ["position", 3],
  ["attitude", 4],
  ["phase", 1],
  ["thrusts", 4],
];

function frame(values: number[]): Frame {
  return new Frame(new Layout(FIELDS), Float32Array.from(values));
}

test("a frame is read as the fields say, little endian", () => {
  const layout = new Layout(FIELDS);
  const bytes = new ArrayBuffer(4 * 13);
  const view = new DataView(bytes);
  for (let i = 0; i < 13; i++) view.setFloat32(4 * i, i + 0.5, true);
  const read = layout.decode(bytes)!;
  assert.equal(read.scalar("time"), 0.5);
  assert.deepEqual(read.vector("position"), [1.5, 2.5, 3.5]);
  assert.deepEqual(read.attitude, [4.5, 5.5, 6.5, 7.5]);
  assert.deepEqual([...read.list("thrusts")], [9.5, 10.5, 11.5, 12.5]);
});

test("a frame of another size is no frame", () => {
  assert.equal(new Layout(FIELDS).decode(new ArrayBuffer(4 * 12)), null);
});

test("what is not sent reads as zeros, and an attitude as level", () => {
  const bare = new Layout([["time", 1]]).decode(new ArrayBuffer(4))!;
  assert.deepEqual(bare.vector("wind"), [0, 0, 0]);
  assert.equal(bare.scalar("held"), 0);
  assert.deepEqual(bare.attitude, [1, 0, 0, 0]);
});

test("a frame without a place cannot be drawn", () => {
  assert.equal(frame([0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1]).drawable, true);
  assert.equal(frame([0, NaN, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1]).drawable, false);
  assert.equal(frame([0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1]).drawable, false);
});

test("between two frames values are mixed, phases jump, and attitudes take the short way", () => {
  const a = frame([1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0]);
  const s = Math.SQRT1_2;
  // a quarter turn about z, written with the opposite sign
  const b = frame([2, 4, 0, 0, -s, 0, 0, -s, 3, 8, 8, 8, 8]);
  const middle = between(a, b, 0.5);
  assert.equal(middle.scalar("time"), 1.5);
  assert.equal(middle.vector("position")[0], 2);
  assert.equal(middle.scalar("phase"), 2);
  const [w, , , z] = middle.attitude;
  assert.ok(Math.abs(w - Math.cos(Math.PI / 8)) < 1e-6);
  assert.ok(Math.abs(z - Math.sin(Math.PI / 8)) < 1e-6);
});
