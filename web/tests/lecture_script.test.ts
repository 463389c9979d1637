import assert from "node:assert/strict";
import { test } from "node:test";

import { checkScript, isScript, readScript, ScriptError } from "../src/ui/lecture_script.ts";
import type { FlightScene } from "../src/wire/messages.generated.ts";

const GOOD = `
title = "Admittance"
mission = "hover"

[[steps]]
text = "It hovers."
camera = "side"
settings.admittance.damping = 4
settings."admittance.mass" = [1, 2, 3]

[[steps]]
text = "A push."
spotlight = "push"
push = { force = [2, 0, 0], duration = 1 }
ghost = "keep"
pause = true
ask = "land"
`;
const SCENE = {
  mission: "hover",
  spring: { stiffness: 6, damping: 2, max_force: 4 },
  parameters: [
    { key: "admittance.damping", label: "", group: "", value: [1, 1, 1], min: 0.2, max: 30 },
    { key: "admittance.mass", label: "", group: "", value: [1, 1, 1], min: 0.3, max: 20 },
    { key: "person.max_force", label: "", group: "", value: 4, min: 0.5, max: 20 },
    { key: "controller.name", label: "", group: "", value: "pid", choices: ["lqr", "pid"] },
  ],
} as unknown as FlightScene;

function refusal(text: string): string {
  try {
    checkScript(readScript(text), SCENE);
  } catch (error) {
    if (error instanceof ScriptError) return error.message;
    throw error;
  }
  return "";
}

const step = (line: string): string => `[[steps]]\ntext = "a"\n[[steps]]\ntext = "b"\n${line}\n`;

test("a script is read, settings by dotted keys however they are written", () => {
  const { title, mission, steps } = readScript(GOOD);
  assert.deepEqual([title, mission], ["Admittance", "hover"]);
  assert.deepEqual(steps[0].settings, { "admittance.damping": 4, "admittance.mass": [1, 2, 3] });
  assert.deepEqual({ ...steps[1].push }, { force: [2, 0, 0], duration: 1 });
  assert.deepEqual([steps[1].ghost, steps[1].pause, steps[1].ask], ["keep", true, "land"]);
  assert.equal(refusal(GOOD), "");
});

test("a bad script is refused with step, key, value and what is allowed", () => {
  const cases: [string, string][] = [
    ["", "steps is missing: must be one table [[steps]] or more"],
    ["steps = []", "steps = []: must be one table [[steps]] or more"],
    ['colour = "red"\n[[steps]]\ntext = "a"', "colour is no key here: must be one of title, mission, steps"],
    ["[[steps]]\npause = true", "step 1: text is missing: must be a text of 1 to 400 characters"],
    [step('camera = "top"'), 'step 2: camera = "top": must be one of behind, side, above, board'],
    [step("pause = 1"), "step 2: pause = 1: must be true or false"],
    [step("push = { force = [2, 0], duration = 1 }"), "step 2: push.force = [2,0]: must be three numbers, N"],
    [step("push = { force = [2, 0, 0] }"), "step 2: push.duration is missing: must be from 0.1 to 60 s"],
    [step("push = { force = [2, 0, 0], duration = 90 }"), "step 2: push.duration = 90: must be from 0.1 to 60 s"],
    [step("push = { force = [3, 3, 0], duration = 1 }"), "step 2: push.force = [3,3,0]: must be 4 N at most, which person.max_force sets"],
    [step("settings.admittance.damping = 99"), "step 2: settings.admittance.damping = 99: must be a number, or 3, from 0.2 to 30"],
    [step("settings.admittance.damping = [1, 2]"), "step 2: settings.admittance.damping = [1,2]: must be a number, or 3, from 0.2 to 30"],
    [step('settings.person.max_force = "much"'), 'step 2: settings.person.max_force = "much": must be a number from 0.5 to 20'],
    [step('settings.controller.name = "x"'), 'step 2: settings.controller.name = "x": must be one of lqr, pid'],
  ];
  for (const [text, reason] of cases) assert.equal(refusal(text), reason);
  assert.match(refusal(step("settings.admitance.mass = 1")), /^step 2: settings\.admitance\.mass: cannot change in flight of hover; must be one of admittance\.damping/);
  assert.match(refusal(step('spotlight = "pull"')), /^step 2: spotlight = "pull": must be one of push, moment, speed/);
  assert.match(refusal('[[steps]]\ntext = "a'), /^line 2, column \d+: /);
});

test("a push may be as strong as the hand that a step before has set", () => {
  assert.equal(refusal(step("settings.person.max_force = 9\npush = { force = [8, 0, 0], duration = 1 }")), "");
});

test("a saved flight follows no script", () => {
  const replay = { ...SCENE, replay: { start: 0, end: 1, speed: 1, ending: null } } as FlightScene;
  assert.throws(() => checkScript(readScript(GOOD), replay), /^Error: a saved flight follows no script/);
});

test("a script is told from a mission by its steps", () => {
  assert.ok(isScript(GOOD));
  assert.ok(isScript('title = "a"\n [[ steps ]]\ntext = "'));
  assert.ok(!isScript('extends = "hover"\n[mission]\nname = "steps"\nstep = 0.001\n'));
});
