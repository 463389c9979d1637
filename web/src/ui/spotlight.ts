// One quantity of the flight, very large, with its last seconds as a curve; paler, that of a ghost.

import { size, subtract } from "../math/vectors.ts";
import type { Frame } from "../wire/frames.ts";
import type { FrameFieldName, STEP_WORDS } from "../wire/messages.generated.ts";
import { el, svg } from "./dom.ts";
import { SPAN } from "./time_window.ts";

const EVERY = 0.05; // s between the frames that are kept
const [WIDE, HIGH] = [400, 100]; // of the curve, in its own units

interface Quantity {
  name: string;
  unit: string;
  digits: number;
  of: (frame: Frame) => number;
}

/** What can stand in the spotlight, by the names that a script has for it. */
export const QUANTITIES: Record<string, Quantity> = {
  push: sized("push", "N", 2, "push"),
  moment: sized("moment of the push", "N m", 2, "push_moment"),
  speed: sized("speed", "m/s", 2, "velocity"),
  x: { name: "position x", unit: "m", digits: 2, of: (frame) => frame.vector("position")[0] },
  y: { name: "position y", unit: "m", digits: 2, of: (frame) => frame.vector("position")[1] },
  height: { name: "height", unit: "m", digits: 2, of: (frame) => frame.vector("position")[2] },
  error: { name: "distance from the reference", unit: "cm", digits: 1, of: gap },
  disturbance: sized("estimated disturbance", "N", 2, "disturbance"),
  thrust: { name: "largest thrust", unit: "N", digits: 1, of: (frame) => Math.max(...frame.list("thrusts")) },
  contact: sized("force of the walls", "N", 1, "contact_force"),
  wind: sized("wind", "m/s", 1, "wind"),
  time: { name: "time", unit: "s", digits: 1, of: (frame) => frame.scalar("time") },
} satisfies Record<(typeof STEP_WORDS.spotlight)[number], Quantity>;
const NAMES = Object.keys(QUANTITIES);

/** The length of a vector of a frame. */
function sized(name: string, unit: string, digits: number, field: FrameFieldName): Quantity {
  return { name, unit, digits, of: (frame) => size(frame.vector(field)) };
}

function gap(frame: Frame): number {
  return 100 * size(subtract(frame.vector("position"), frame.vector("reference")));
}

export class Spotlight {
  readonly element = el("div", { class: "spotlight" });
  private readonly menu = el("select", { "aria-label": "Quantity in the spotlight" });
  private readonly value = el("b");
  private readonly unit = el("span");
  private readonly ghost = el("p", { class: "ghost" });
  private readonly curves = ["ghost", "own"].map((kind) => svg("polyline", { class: kind, points: "" }));
  private frames: Frame[] = [];

  constructor() {
    this.menu.append(...NAMES.map((name) => el("option", { value: name }, QUANTITIES[name].name)));
    this.menu.addEventListener("change", () => this.menu.blur());
    const curve = svg("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, preserveAspectRatio: "none" }, ...this.curves);
    this.element.append(this.menu, el("p", { class: "value" }, this.value, this.unit), this.ghost, curve);
  }

  show(name: string): void {
    this.menu.value = name;
  }

  /** Shows the quantity after or before this one. */
  turn(by: number): void {
    this.show(NAMES[(this.menu.selectedIndex + by + NAMES.length) % NAMES.length]);
  }

  frame(frame: Frame): void {
    const time = frame.scalar("time");
    const passed = time - (this.frames.at(-1)?.scalar("time") ?? -1);
    if (passed < 0 || passed > SPAN) this.frames = this.frames.filter((one) => time - one.scalar("time") > 0);
    else if (passed < EVERY) return;
    this.frames.push(frame);
    while (this.frames[0].scalar("time") < time - SPAN) this.frames.shift();
  }

  draw(now: Frame): void {
    const { unit, digits, of } = QUANTITIES[this.menu.value];
    const rounded = (frame: Frame): number => Number(of(frame).toFixed(digits)) + 0; // no −0
    const words = (frame: Frame): string => rounded(frame).toFixed(digits).replace("-", "\u2212");
    [this.value.textContent, this.unit.textContent] = [words(now), unit];
    this.ghost.textContent = now.ghost ? `ghost ${words(now.ghost)}` : "";
    const ghosts = this.frames.map((frame) => (frame.ghost ? of(frame.ghost) : NaN));
    const own = this.frames.map(of);
    const seen = [...ghosts, ...own].filter(Number.isFinite);
    const [low, high] = [Math.min(0, ...seen), Math.max(1e-3, ...seen)];
    const end = now.scalar("time");
    [ghosts, own].forEach((values, i) => {
      const points = values.flatMap((value, k) => {
        const x = WIDE * (1 - (end - this.frames[k].scalar("time")) / SPAN);
        const y = HIGH * (1 - (value - low) / (high - low));
        return Number.isFinite(value) ? [`${x.toFixed(1)},${y.toFixed(1)}`] : [];
      });
      this.curves[i].setAttribute("points", points.join(" "));
    });
  }
}
