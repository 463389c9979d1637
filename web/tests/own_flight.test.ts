import assert from "node:assert/strict";
import { test } from "node:test";

import { linkOf, readLink } from "../src/flight/link.ts";
import type { PacingConstants } from "../src/flight/manifest.ts";
import { Pacer } from "../src/flight/pacer.ts";
import { filled, shown } from "../src/flight/refusal.ts";
import type { SceneParameter } from "../src/wire/messages.generated.ts";

test("a text has six digits of its numbers, and keeps the braces that no value is for", () => {
  const values = { a: 0.1 + 0.2, b: 1234567, c: "x" };
  assert.equal(filled("{a} and {b} and {c} and {d}", values), "0.3 and 1234570 and x and {d}");
});

test("a value is shown on one line of bounded length", () => {
  assert.equal(shown('a"b'), '"a\\"b"');
  assert.equal(shown(Array.from({ length: 60 }, () => 1)).length, 70);
});

test("a link says mission and settings, and what is no number stays a text", () => {
  const lists = "a=[3, 0, 0]&b=[2]&c=[3,[0]]&d=%5B1,2%5D";
  assert.deepEqual(readLink(`#${lists}`).settings, [["a", [3, 0, 0]], ["b", [2]], ["c", "[3,[0]]"], ["d", [1, 2]]]);
  const { mission, settings } = readLink("#mission=iris&admittance.mass=2&wind.velocity=3,0,-0.5&x=abc&y=&z=1,a");
  assert.equal(mission, "iris");
  const expected = [["admittance.mass", 2], ["wind.velocity", [3, 0, -0.5]], ["x", "abc"], ["y", ""], ["z", "1,a"]];
  assert.deepEqual(settings, expected);
  assert.deepEqual(readLink(""), { mission: null, settings: [] });
});

test("a link holds the settings that differ from the mission's, exactly", () => {
  const base = { label: "", group: "" };
  const parameters: SceneParameter[] = [
    { ...base, key: "same", value: [1, 1], initial: [1, 1] },
    { ...base, key: "number", value: 0.1 + 0.2, initial: 0.3 },
    { ...base, key: "list", value: [1, -2e-7, 3], initial: [0, 0, 0] },
  ];
  const link = linkOf("rotor-loss", parameters);
  assert.equal(link, "#mission=rotor-loss&number=0.30000000000000004&list=1,-2e-7,3");
  assert.deepEqual(readLink(link).settings, [["number", 0.1 + 0.2], ["list", [1, -2e-7, 3]]]);
});

const PACING = { most_behind: 0.1, window: 1 } as PacingConstants;

function paced(): { pacer: Pacer; wait: (seconds: number) => void } {
  let now = 0;
  return { pacer: new Pacer(0.001, PACING, () => now), wait: (seconds) => (now += seconds) };
}

test("as many steps are due as time has passed, slower if asked, and none in a pause", () => {
  const { pacer, wait } = paced();
  wait(0.0105);
  assert.equal(pacer.due(), 10);
  pacer.flew(10);
  pacer.speed = 0.5;
  wait(0.01);
  assert.equal(pacer.due(), 5);
  pacer.paused = true;
  wait(5);
  assert.equal(pacer.due(), 0);
});

test("what is due for too long is dropped, and the pace shows it", () => {
  const { pacer, wait } = paced();
  wait(3);
  assert.equal(pacer.due(), 100);
  assert.equal(pacer.mostBehind, 0.1);
  for (let i = 0; i < 100; i++) {
    wait(0.01);
    pacer.due();
    pacer.flew(5);
  }
  assert.ok(Math.abs(pacer.factor - 0.5) < 0.01, String(pacer.factor));
});
