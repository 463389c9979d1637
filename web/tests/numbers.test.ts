import assert from "node:assert/strict";
import { test } from "node:test";

import { formatNumber, SliderScale } from "../src/ui/numbers.ts";
import { Latency } from "../src/wire/latency.ts";

test("numbers are shown with four figures at most", () => {
  assert.deepEqual([0, 0.1 + 0.2, 12345.678, -2.5].map(formatNumber), ["0", "0.3", "12350", "-2.5"]);
});

test("a slider goes from end to end, and stays at each step where it was put", () => {
  for (const [low, high] of [
    [0, 5],
    [0.01, 20],
    [-8, 8],
    [100, 110],
    [0.1, 12.345],
  ] as const) {
    const slide = new SliderScale(low, high);
    assert.equal(slide.place(low), 0);
    assert.equal(slide.place(high), 1000);
    assert.equal(slide.value(1000), high);
    for (let place = 0; place <= 1000; place++) assert.equal(slide.place(slide.value(place)), place);
  }
});

test("a wide range is fine where values are small", () => {
  assert.ok(new SliderScale(0.001, 10).value(500) < 0.2);
});

test("the delay of a message ends with the first picture that echoes it", () => {
  const latency = new Latency();
  assert.equal(latency.median, null);
  latency.note(7, 100, 101);
  latency.note(8, 110, 111);
  latency.drawn(7, 120);
  latency.drawn(7, 150);
  latency.drawn(8, 140);
  assert.equal(latency.median, 30);
});

test("an event's clock that cannot be right is not believed", () => {
  const latency = new Latency();
  latency.note(1, 9e9, 50);
  latency.drawn(1, 60);
  assert.equal(latency.median, 10);
});
