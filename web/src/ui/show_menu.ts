// The menu of what is shown, heard and felt; the browser remembers it.

import type { Overlay, Overlays } from "../view/picture.ts";
import { byId, el, icon, toggle } from "./dom.ts";
import type { Sense, Senses } from "./senses.ts";
import { keep, keptData } from "./storage.ts";

export type Shown = Overlays & Senses;

const KEPT_AS = "tandemlift.show";
type Row<T> = [name: T, text: string, on: boolean];

const SEEN: Row<Overlay>[] = [
  ["push", "push and moment", true],
  ["zone", "threshold", true],
  ["ghost", "reference", true],
  ["thrust", "thrusts", true],
  ["wind", "wind", true],
  ["trail", "path flown", true],
  ["trails", "paths stay", false],
  ["person", "person, 1.75 m", false],
];
const FELT: Row<Sense>[] = [
  ["rotors", "sound of the rotors", false],
  ["touches", "sound of touches", false],
  ["vibration", "vibration", false],
];

/** What the browser remembers, and the usual for all else. */
export function rememberedShown(): Shown {
  const usual = Object.fromEntries([...SEEN, ...FELT].map(([name, , on]) => [name, on])) as Shown;
  const before = Object.entries(keptData(KEPT_AS) ?? {}).filter(([name, on]) => {
    return name in usual && typeof on === "boolean";
  });
  return { ...usual, ...Object.fromEntries(before) };
}

export class ShowMenu {
  readonly button = el("button", { type: "button", "aria-expanded": "false", "aria-controls": "show" });
  readonly follow: HTMLElement;
  private readonly menu = byId("show");

  constructor(shown: Shown, follow: (on: boolean) => void) {
    const toggles = (names: Row<keyof Shown>[]): HTMLElement[] =>
      names.map(([name, text]) =>
        toggle(text, shown[name], (on) => {
          shown[name] = on;
          keep(KEPT_AS, JSON.stringify(shown));
        }),
      );
    const felt = "vibrate" in navigator ? FELT : FELT.filter(([name]) => name !== "vibration");
    this.follow = toggle("camera follows (F)", true, follow);
    this.menu.replaceChildren(...toggles(SEEN), el("hr"), ...toggles(felt), el("hr"), this.follow);
    this.button.append(icon("eye"), el("span", {}, "Show"));
    this.button.addEventListener("click", () => this.open(this.menu.hidden !== false));
    window.addEventListener("pointerdown", ({ target }) => {
      if (target instanceof Node && !this.menu.contains(target) && !this.button.contains(target)) this.open(false);
    });
    window.addEventListener("keydown", ({ key }) => {
      if (key !== "Escape" || this.menu.hidden !== false) return;
      this.open(false);
      this.button.focus();
    });
  }

  private open(on: boolean): void {
    this.menu.hidden = !on;
    this.button.setAttribute("aria-expanded", String(on));
    if (on) this.menu.querySelector("input")!.focus();
  }
}
