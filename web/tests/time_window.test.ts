import assert from "node:assert/strict";
import { test } from "node:test";

import { History, indexOf } from "../src/ui/history.ts";
import { nearest } from "../src/ui/plot_cursor.ts";
import { pinched, SPAN, TimeWindow, within, zoomed } from "../src/ui/time_window.ts";
import { Frame, Layout } from "../src/wire/frames.ts";
import type { FlightScene } from "../src/wire/messages.generated.ts";

test("a zoom keeps its time in place, and its inverse takes it back", () => {
  const [from, to] = zoomed([10, 30], 15, 0.5);
  assert.deepEqual([from, to], [12.5, 22.5]);
  assert.equal((15 - from) / (to - from), (15 - 10) / (30 - 10));
  assert.deepEqual(zoomed([from, to], 15, 2), [10, 30]);
});

test("two fingers keep the times under them, wherever they go", () => {
  const [from, to] = pinched([12, 18], [0.1, 0.7]);
  const length = to - from;
  assert.ok(Math.abs(from + 0.1 * length - 12) < 1e-9);
  assert.ok(Math.abs(from + 0.7 * length - 18) < 1e-9);
});

test("a stretch stays within what was flown, and long enough to be read", () => {
  assert.deepEqual(within([-5, 5], [0, 60]), [0, 10]);
  assert.deepEqual(within([55, 65], [0, 60]), [50, 60]);
  assert.deepEqual(within([-100, 200], [0, 60]), [0, 60]);
  const [from, to] = within([20, 20], [0, 60]);
  assert.ok(to - from > 0.1 && from < 20 && to > 20);
});

function flying(): { window: TimeWindow; at: (time: number) => void } {
  let now = 50;
  return { window: new TimeWindow(() => [0, now], () => now), at: (time) => (now = time) };
}

test("the last seconds are shown, and go on, until a person zooms and comes back", () => {
  const { window, at } = flying();
  assert.deepEqual(window.shown, [50 - SPAN, 50]);
  window.zoom([10, 20]);
  at(60);
  assert.deepEqual(window.shown, [10, 20]);
  window.follow();
  assert.deepEqual(window.shown, [60 - SPAN, 60]);
});

test("a drag stands on the plot although time goes on", () => {
  const { window, at } = flying();
  window.hold();
  at(51);
  assert.deepEqual(window.shown, [30, 50]);
  window.release();
  assert.deepEqual(window.shown, [31, 51]);
});

test("a chosen moment comes into view, is shown unless the mouse is elsewhere, and is forgotten with its flight", () => {
  const { window } = flying();
  window.choose(5);
  assert.ok(window.shown[0] <= 5 && window.shown[1] >= 5);
  assert.equal(window.cursor, 5);
  window.hovered = 7;
  assert.equal(window.cursor, 7);
  window.hovered = null;
  window.restart();
  assert.equal(window.cursor, null);
  assert.equal(window.isZoomed, false);
});

test("a place among numbers, and the nearest of them", () => {
  assert.deepEqual([0, 1, 1.5, 9].map((value) => indexOf([1, 2, 4], value)), [0, 0, 1, 3]);
  assert.deepEqual([-9, 1.4, 1.6, 3.1, 99].map((value) => nearest([1, 2, 4], value)), [0, 0, 1, 2, 2]);
});

const SCENE = { mission: "a", fields: [["time", 1]], vehicle: { quadrotors: [] } } as unknown as FlightScene;

test("the whole flight is kept, what is rewound is forgotten, and so is all after a gap", () => {
  const history = new History(SCENE);
  const layout = new Layout(SCENE.fields);
  const add = (time: number): boolean => history.add(new Frame(layout, Float32Array.of(time)));
  for (let i = 0; i <= 6000; i++) add(i / 60);
  assert.deepEqual(history.flown, [0, 100]);
  history.show([10, 11]);
  const times = [...history.column("time")];
  assert.ok(times[0] <= 10 && times.at(-1)! >= 11 && times.length < 25, String(times.length));
  assert.equal(add(40), true);
  assert.deepEqual(history.flown, [0, 40]);
  assert.equal(add(80), true);
  assert.deepEqual(history.flown, [80, 80]);
});
