// The panel: the hand, what is drawn, and every setting that the scene offers, by groups.

import type { Control, Scene, Setting } from "../wire/protocol.ts";
import type { Choice } from "../view/graphics.ts";
import type { Overlay, Shown } from "../view/picture.ts";
import { type Ask, ControlBox } from "./control.ts";
import { choice, el, icon, toggle } from "./dom.ts";
import { RotorMap } from "./rotormap.ts";

const MOST = "person.max_force"; // the control that bounds the force of the keys
const LEAST = 0.1; // N

const OVERLAYS: Record<Overlay, string> = {
  push: "push",
  zone: "threshold zone",
  ghost: "ghost of the reference",
  thrust: "thrusts",
  wind: "wind",
  trail: "way flown",
};

/** What the panel sets on the page itself. */
export interface Own {
  grabAt(at: "point" | "centre"): void;
  plane(plane: "facing" | "level"): void;
  ways(ways: "view" | "world"): void;
  graphics(choice: Choice): void;
  shown: Shown;
  strength: number; // N, of the keyboard
}

export interface Asks extends Ask {
  restoreAll: () => void;
  kill: (rotor: number) => void;
}

export class Panel {
  private boxes = new Map<string, ControlBox>();
  private map: RotorMap | null = null;
  private open: Record<string, boolean> = {};
  private limit: ((newtons: number) => void) | null = null;
  private initial: { mission: string; values: Map<string, Setting> } = { mission: "", values: new Map() };

  constructor(
    private readonly place: HTMLElement,
    private readonly own: Own,
    private readonly asks: Asks,
  ) {}

  scene(scene: Scene): void {
    for (const one of this.place.querySelectorAll("details")) this.open[one.dataset["name"] ?? ""] = one.open;
    const live = !scene.replay;
    this.boxes = new Map(this.remembered(scene).map((control) => [control.key, new ControlBox(control, this.asks)]));
    this.map = live ? new RotorMap(scene, this.asks.kill) : null;
    const groups = [...new Set(scene.controls.map(({ group }) => group))].map((group) => {
      const own = scene.controls.filter((control) => control.group === group);
      return this.group(
        group,
        own.map(({ key }) => this.boxes.get(key)!.element),
      );
    });
    this.place.replaceChildren(
      ...(live ? [this.group("hand", this.hand(scene.spring?.max_force ?? this.own.strength), true)] : []),
      ...groups,
      ...(groups.length ? [this.restore()] : []),
      ...(this.map ? [this.group("rotors", [this.map.element])] : []),
      this.group("picture", this.picture(), !live),
    );
  }

  thrusts(values: Float32Array): void {
    this.map?.thrusts(values);
  }

  dead(rotors: readonly number[]): void {
    this.map?.dead(rotors);
  }

  changed(key: string, value: Setting, duration: number): void {
    this.boxes.get(key)?.changed(value, duration);
    if (key === MOST) this.limit?.(Number(value));
  }

  /** Shows the reason at the control that it is about; false if there is none. */
  refused(what: string, reason: string): boolean {
    const box = this.boxes.get(what.replace(/^(set|restore) /, ""));
    box?.refuse(reason);
    return box !== undefined;
  }

  /** Controls with the values that they had when the mission was first seen: a reset keeps what was changed. */
  private remembered({ mission, controls }: Scene): Control[] {
    if (mission !== this.initial.mission) this.initial = { mission, values: new Map() };
    const { values } = this.initial;
    return controls.map((control) => {
      if (!values.has(control.key)) values.set(control.key, control.initial ?? control.value);
      return { ...control, initial: values.get(control.key)! };
    });
  }

  private group(name: string, children: HTMLElement[], open = false): HTMLElement {
    const summary = el("summary", {}, name);
    return el("details", { open: this.open[name] ?? open, "data-name": name }, summary, ...children);
  }

  private hand(most: number): HTMLElement[] {
    const { own } = this;
    const force = this.strength(most);
    const grabs = choice("Where the hand pulls", { point: "where I grab", centre: "centre of mass" }, "point", (at) => {
      own.grabAt(at);
    });
    const ways = choice("Directions of the keys", { view: "as I look", world: "world axes" }, "view", (value) => {
      own.ways(value);
    });
    const planes = choice("Plane of the hand", { facing: "facing me", level: "level" }, "facing", (plane) => {
      own.plane(plane);
    });
    return [
      row("Pull", grabs),
      row("Hand moves", planes),
      row("Keys push with", el("label", { class: "newtons", for: "key-force" }, force, "N")),
      row("Keys point", ways),
    ];
  }

  /** How hard the keys push: no harder than the hand of the mission can. */
  private strength(most: number): HTMLInputElement {
    const { own } = this;
    const force = el("input", { type: "number", min: LEAST, step: 0.1, value: own.strength, id: "key-force" });
    const take = (): void => {
      own.strength = Math.min(Math.max(force.valueAsNumber || own.strength, LEAST), Number(force.max));
      force.value = String(own.strength);
    };
    this.limit = (newtons) => {
      force.max = String(newtons);
      take();
    };
    this.limit(most);
    force.addEventListener("change", take);
    return force;
  }

  private picture(): HTMLElement[] {
    const { own } = this;
    const names = Object.keys(OVERLAYS) as Overlay[];
    const toggles = names.map((name) => toggle(OVERLAYS[name], own.shown[name], (on) => (own.shown[name] = on)));
    const graphics = choice("Graphics", { auto: "auto", full: "full", light: "light" }, "auto", (value) => {
      own.graphics(value);
    });
    return [el("div", { class: "toggles-list" }, ...toggles), row("Graphics", graphics)];
  }

  private restore(): HTMLElement {
    const all = el("button", { type: "button", class: "restore-all" }, icon("back"), "All back to the mission's");
    all.addEventListener("click", () => {
      this.asks.restoreAll();
    });
    return all;
  }
}

function row(name: string, content: HTMLElement): HTMLElement {
  return el("div", { class: "row" }, el("span", {}, name), content);
}
