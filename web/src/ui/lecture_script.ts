// The script of a lecture: a TOML file of steps, read and checked.

import { parse, type TomlError, type TomlTable, type TomlValue } from "smol-toml";

import { size } from "../math/vectors.ts";
import type { View } from "../view/camera.ts";
import { type FlightScene, MAX_FORCE, type ParameterValue, STEP_WORDS, type Vector } from "../wire/messages.generated.ts";

export interface LectureStep {
  text: string;
  spotlight?: string;
  camera?: View;
  settings: Record<string, ParameterValue>; // by dotted key
  push?: { force: Vector; duration: number }; // N, world axes; s
  ask?: "lift" | "land";
  ghost?: "keep" | "end";
  pause?: boolean;
}

export interface LectureScript {
  title?: string;
  mission?: string;
  steps: LectureStep[];
}

/** What is wrong with a script: names the step, the key, the value, and what is allowed. */
export class ScriptError extends Error {}

type Rule = readonly [allowed: string, fits: (value: TomlValue) => boolean];
type Rules = Record<string, Rule>;

const oneOf = (...names: string[]): Rule => [`one of ${names.join(", ")}`, (value) => names.includes(value as string)];
const isTable = (value: TomlValue): value is TomlTable =>
  typeof value === "object" && !Array.isArray(value) && !(value instanceof Date);
const words = (most: number): Rule => [
  `a text of 1 to ${most} characters`,
  (value) => typeof value === "string" && value.trim() !== "" && value.length <= most,
];
const numbers = (value: TomlValue): boolean => Array.isArray(value) && value.every(Number.isFinite);

const SCRIPT: Rules = {
  title: words(80),
  mission: words(100),
  steps: ["one table [[steps]] or more", (value) => Array.isArray(value) && value.length > 0 && value.every(isTable)],
};
const STEP: Rules = {
  text: words(400),
  spotlight: oneOf(...STEP_WORDS.spotlight),
  camera: oneOf(...STEP_WORDS.camera),
  settings: ["a table of keys of the mission", isTable],
  push: ["a table with force and duration, as { force = [2, 0, 0], duration = 1.0 }", isTable],
  ask: oneOf(...STEP_WORDS.ask),
  ghost: oneOf(...STEP_WORDS.ghost),
  pause: ["true or false", (value) => typeof value === "boolean"],
};
const PUSH: Rules = {
  force: ["three numbers, N", (value) => numbers(value) && (value as number[]).length === 3],
  duration: ["from 0.1 to 60 s", (value) => typeof value === "number" && value >= 0.1 && value <= 60],
};

/** Whether a text is meant as a script, and not as a mission. */
export const isScript = (text: string): boolean => /^\s*(\[\[\s*steps\s*\]\]|steps\s*=)/m.test(text);

/** The script in a text. */
export function readScript(text: string): LectureScript {
  const script = tables(text);
  check("", script, SCRIPT, ["steps"]);
  const steps = (script["steps"] as TomlTable[]).map((step, i) => {
    const where = `step ${i + 1}: `;
    check(where, step, STEP, ["text"]);
    if (step["push"]) check(`${where}push.`, step["push"] as TomlTable, PUSH, Object.keys(PUSH));
    return { ...step, settings: dotted((step["settings"] ?? {}) as TomlTable) } as unknown as LectureStep;
  });
  return { ...script, steps };
}

/** Refuses a script that a flight cannot follow. */
export function checkScript({ steps }: LectureScript, scene: FlightScene): void {
  if (scene.replay) throw new ScriptError("a saved flight follows no script: open it in a page that flies");
  let most = scene.spring.max_force;
  steps.forEach(({ settings, push }, i) => {
    const where = `step ${i + 1}: `;
    for (const [key, value] of Object.entries(settings)) checkSetting(`${where}settings.${key}`, key, value, scene);
    most = Number(settings[MAX_FORCE] ?? most);
    const strongest = `${most} N at most, which ${MAX_FORCE} sets`;
    if (push && size(push.force) > most) refuse(`${where}push.force`, push.force, strongest);
  });
}

function tables(text: string): TomlTable {
  try {
    return parse(text);
  } catch (error) {
    const { line, column, message } = error as TomlError;
    throw new ScriptError(`line ${line}, column ${column}: ${message.split("\n")[0]}`);
  }
}

function check(where: string, table: TomlTable, rules: Rules, needed: string[]): void {
  for (const key of needed) {
    if (!(key in table)) throw new ScriptError(`${where}${key} is missing: must be ${rules[key][0]}`);
  }
  for (const [key, value] of Object.entries(table)) {
    const known = Object.keys(rules).join(", ");
    if (!(key in rules)) throw new ScriptError(`${where}${key} is no key here: must be one of ${known}`);
    if (!rules[key][1](value)) refuse(`${where}${key}`, value, rules[key][0]);
  }
}

function checkSetting(name: string, key: string, value: ParameterValue, { mission, parameters }: FlightScene): void {
  const parameter = parameters.find((one) => one.key === key);
  const known = parameters.map((one) => one.key).join(", ");
  if (!parameter) throw new ScriptError(`${name}: cannot change in flight of ${mission}; must be one of ${known}`);
  const { choices, min = -Infinity, max = Infinity, value: now } = parameter;
  if (choices) {
    if (!choices.includes(value as string)) refuse(name, value, `one of ${choices.join(", ")}`);
    return;
  }
  const count = Array.isArray(now) ? now.length : 1;
  const parts = [value].flat() as number[];
  const fits = parts.every((part) => typeof part === "number" && part >= min && part <= max);
  const shape = count > 1 ? `a number, or ${count}, from` : "a number from";
  if (!fits || (Array.isArray(value) && parts.length !== count)) refuse(name, value, `${shape} ${min} to ${max}`);
}

/** Refuses a value. */
export function refuse(name: string, value: unknown, allowed: string): never {
  throw new ScriptError(`${name} = ${JSON.stringify(value)}: must be ${allowed}`);
}

/** Tables within tables by dotted keys. */
function dotted(table: TomlTable, before = ""): Record<string, ParameterValue> {
  const entries = Object.entries(table).map(([key, value]): Record<string, ParameterValue> =>
    isTable(value) ? dotted(value, `${before}${key}.`) : { [before + key]: value as ParameterValue },
  );
  return Object.assign({}, ...entries) as Record<string, ParameterValue>;
}
