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

test("columns change places with the flight and its ghost, and an earlier ghost is forgotten", () => {
  const history = new History(SCENE);
  const column = (name: string): number[] => [...history.column(name)];
  const ghost = (swaps: number) => ({ mission: "a", parameters: [], swaps });
  history.ghost(undefined, ghost(0));
  history.add(frame(0, 1, 0, 0));
  history.add(frame(0.1, 2, 0, 0, 0.1, 8, 0, 0));
  history.show([0, 1]);
  assert.deepEqual([column("position0"), column(`${GHOST}position0`)], [[1, 2], [NaN, 8]]);
  history.ghost(ghost(0), ghost(1));
  assert.deepEqual([column("position0"), column(`${GHOST}position0`)], [[NaN, 8], [1, 2]]);
  history.ghost(ghost(1), ghost(1));
  assert.deepEqual(column("position0"), [NaN, 8]);
  history.ghost(undefined, ghost(0));
  assert.deepEqual(column(`${GHOST}position0`), [NaN, NaN]);
});
