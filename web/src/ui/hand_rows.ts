// The rows of the panel about the hand: where it pulls, in which plane it moves, how keys push.

import type { HandOptions } from "../hand/options.ts";
import { choice, el } from "./dom.ts";

const MIN_FORCE = 0.1; // N

const PLANES = { facing: "facing me", level: "level" };

/** The force of the keys, which the mission's hand limits. */
export interface LimitedForce {
  limit(newtons: number): void;
}

/** The rows, the force of the keys, and the choice of a plane. */
export interface HandRows {
  rows: HTMLElement[];
  force: LimitedForce;
  planes: HTMLElement;
}

export function handRows(options: HandOptions): HandRows {
  const { input, force } = forceInput(options);
  const pull = choice("Where the hand pulls", { point: "at the point", centre: "centre of mass" }, options.at, (at) => {
    options.at = at;
  });
  const planes = choice("Plane of the hand", PLANES, options.plane, (plane) => {
    [options.plane, options.planeChosen] = [plane, true];
  });
  const ways = { view: "as seen", world: "world axes" };
  const directions = choice("Directions of the keys", ways, options.directions, (value) => {
    options.directions = value;
  });
  const rows = [
    row("Pull", pull),
    row("Plane", planes),
    row("Key, tap force", el("label", { class: "newtons", for: "key-force" }, input, "N")),
    row("Keys push", directions),
  ];
  return { rows, force, planes };
}

/** Over the picture: what a drag or a key does, and the frequency of a shake. */
export function handKinds(options: HandOptions): HTMLElement[] {
  const range = el("input", { type: "range", min: 0.5, max: 10, step: 0.5, value: options.frequency, title: "Frequency of the shake" });
  const shown = el("output", {}, `${options.frequency} Hz`);
  const slider = el("label", { class: "newtons", hidden: true }, range, shown);
  range.addEventListener("input", () => {
    options.frequency = range.valueAsNumber;
    shown.textContent = `${options.frequency} Hz`;
  });
  const kinds = choice("What a drag of the beam and a key do", { push: "Push", shake: "Shake", tap: "Tap" }, options.kind, (kind) => {
    options.kind = kind;
    slider.hidden = kind !== "shake";
  });
  return [kinds, slider];
}

function forceInput(options: HandOptions): { input: HTMLInputElement; force: LimitedForce } {
  const input = el("input", { type: "number", min: MIN_FORCE, step: 0.1, value: options.force, id: "key-force" });
  const take = (): void => {
    options.force = Math.min(Math.max(input.valueAsNumber || options.force, MIN_FORCE), Number(input.max));
    input.value = String(options.force);
  };
  input.addEventListener("input", () => input.setCustomValidity(""));
  input.addEventListener("change", () => {
    const isNone = Number.isNaN(input.valueAsNumber);
    take();
    input.setCustomValidity(isNone ? `The force must be a finite number of newtons: it stays ${options.force} N` : "");
    if (isNone) input.reportValidity();
  });
  const limit = (newtons: number): void => {
    input.max = String(newtons);
    take();
  };
  return { input, force: { limit } };
}

/** A name and what belongs to it, side by side. */
export function row(name: string, content: HTMLElement): HTMLElement {
  return el("div", { class: "row" }, el("span", {}, name), content);
}
