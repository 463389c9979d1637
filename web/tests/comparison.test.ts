import assert from "node:assert/strict";
import { test } from "node:test";

import { differences } from "../src/ui/comparison.ts";
import { GHOST, History } from "../src/ui/history.ts";
import { Frame, Layout } from "../src/wire/frames.ts";
import type { FlightScene, FrameFieldName, ParameterValue, SceneParameter } from "../src/wire/messages.generated.ts";

const parameter = (key: string, value: ParameterValue, unit?: string, group = "admittance"): SceneParameter => {
  const label = key.split(".").at(-1)!;
  return { key, label, group, value, ...(unit && { unit }) };
};

test("what differs is said with both values; a name that occurs twice with its group", () => {
  const ghost = [
    parameter("admittance.damping", [10, 10, 10], "N s/m"),
    parameter("person.damping", 2, "N s/m", "hand spring"),
    parameter("wind.velocity", [0, 0, 0], "m/s", "world"),
    parameter("controller.name", "nftsmc", undefined, "controller"),
  ];
  assert.equal(differences(ghost, ghost), "");
  const now = ghost.map((one, i) => ({ ...one, value: [[25, 25, 25], 2, [3, 0, 0], "pid"][i] }));
  assert.equal(
    differences(ghost, now),
    "Ghost: admittance damping 10, now: 25 N s/m; velocity 0, now: 3, 0, 0 m/s; name nftsmc, now: pid.",
  );
});

const FIELDS: [FrameFieldName, number][] = [
  ["time", 1],
  ["position", 3],
];
const SCENE = { mission: "a", fields: FIELDS, vehicle: { quadrotors: [] as unknown[] } } as FlightScene;

function frame(...values: number[]): Frame {
  return new Frame(new Layout(FIELDS), Float32Array.from(values));
}

test("a frame has a ghost only if the numbers of one follow", () => {
  assert.equal(frame(1, 2, 3, 4).ghost, null);
  assert.deepEqual(frame(1, 2, 3, 4, 1, 5, 6, 7).ghost?.vector("position"), [5, 6, 7]);
});

const ghost = (begun: number, swaps: number, mission = "a") => ({ mission, controller: "c", parameters: [], begun, swaps });

/** A history of three samples: one before a ghost began, of which the next two have both. */
function compared(): History {
  const history = new History(SCENE);
  history.add(frame(0, 1, 0, 0));
  assert.ok(history.continue({ ...SCENE, ghost: ghost(1, 0) }));
  history.add(frame(0.1, 2, 0, 0, 0.1, 8, 0, 0));
  history.add(frame(0.2, 3, 0, 0, 0.2, 9, 0, 0));
  history.show([0, 1]);
  return history;
}
const columns = (history: History): number[][] => ["", GHOST].map((whose) => [...history.column(`${whose}position0`)]);

test("a ghost has flown as the flight did until it began; after a swap and an end both are whole", () => {
  const history = compared();
  assert.deepEqual(columns(history), [[1, 2, 3], [1, 8, 9]]);
  assert.ok(history.continue({ ...SCENE, ghost: ghost(1, 1) }));
  assert.deepEqual(columns(history), [[1, 8, 9], [1, 2, 3]]);
  assert.ok(history.continue(SCENE)); // it ends
  history.add(frame(0.3, 10, 0, 0));
  history.show([0, 1]);
  assert.deepEqual(columns(history)[0], [1, 8, 9, 10]);
});

test("another ghost takes the place of the one before, from the flight's beginning", () => {
  const history = compared();
  assert.ok(history.continue({ ...SCENE, ghost: ghost(2, 0) }));
  assert.deepEqual(columns(history), [[1, 2, 3], [1, 2, 3]]);
});

test("of two missions the history goes on over a swap and an end; a mission that is opened begins its own", () => {
  const history = new History(SCENE);
  assert.ok(history.continue({ ...SCENE, ghost: ghost(1, 0, "b") }));
  history.add(frame(0, 1, 0, 0, 0, 5, 0, 0));
  assert.ok(history.continue({ ...SCENE, mission: "b", ghost: ghost(1, 1) }));
  assert.ok(history.continue({ ...SCENE, mission: "b" }));
  history.show([0, 1]);
  assert.deepEqual(columns(history)[0], [5]);
  assert.ok(!history.continue(SCENE));
});
