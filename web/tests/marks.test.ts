import assert from "node:assert/strict";
import { test } from "node:test";

import { Marks } from "../src/ui/marks.ts";
import { Frame, Layout } from "../src/wire/frames.ts";

const LAYOUT = new Layout([
  ["time", 1],
  ["phase", 1],
  ["push", 3],
  ["contact_part", 1],
]);

/** Sixty frames a second, of a flight pushed as a function of time says, and touching likewise. */
function flown(seconds: number, push: (time: number) => number, touch: (time: number) => number): Marks {
  const marks = new Marks();
  for (let i = 0; i <= 60 * seconds; i++) {
    const time = i / 60;
    marks.frame(new Frame(LAYOUT, Float32Array.of(time, time < 2 ? 1 : 2, 0, push(time), 0, touch(time))));
  }
  return marks;
}

const during = (from: number, to: number, value: number) => (time: number) => (time >= from && time < to ? value : 0);

test("a push is one mark with its greatest force and its duration, and a touch says what touches", () => {
  const marks = flown(6, (time) => during(1, 3, 2)(time) + during(2, 2.1, 0.5)(time), during(4, 4.5, -1));
  assert.deepEqual(
    marks.all.map(({ kind, text }) => [kind, text]),
    [
      ["push", "push of 2.5 N at most, for 2.0 s"],
      ["touch", "the beam touches"],
    ],
  );
  assert.ok(Math.abs(marks.all[0].time - 1) < 0.02);
});

test("pushes that follow one another at once are one, others are two", () => {
  const twice = (gap: number) => (time: number) => during(1, 1.5, 1)(time) + during(1.5 + gap, 2 + gap, 1)(time);
  assert.equal(flown(6, twice(0.3), () => 0).all.length, 1);
  assert.equal(flown(6, twice(0.8), () => 0).all.length, 2);
});

test("phases are stretches that meet", () => {
  const { phases } = flown(4, () => 0, () => 0);
  assert.deepEqual(phases.map(({ phase }) => phase), [1, 2]);
  assert.equal(phases[0].to, phases[1].from);
});

test("a finding is one mark, whatever it is told to be later, and goes with its flight", () => {
  const marks = new Marks();
  marks.findings([{ kind: "touched", time: 2, text: "a little" }]);
  const [mark] = marks.all;
  marks.findings([{ kind: "touched", time: 2, text: "much" }, { kind: "saturated", time: 3, text: "long" }]);
  assert.equal(marks.all[0], mark);
  assert.deepEqual(marks.all.map(({ text }) => text), ["touched: much", "saturated: long"]);
  marks.findings([]);
  assert.deepEqual(marks.all, []);
});

test("what is rewound has no marks", () => {
  const marks = flown(6, during(1, 5, 1), () => 0);
  marks.setting(3, "mass");
  marks.cut(2.5);
  assert.deepEqual(marks.all.map(({ kind }) => kind), ["push"]);
  assert.ok(marks.phases.at(-1)!.to <= 2.5);
});
