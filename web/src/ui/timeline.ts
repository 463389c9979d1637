// The whole flight on one line: its phases, a mark for each event, the stretch that the plots show, a chosen moment.

import type { Phase } from "../wire/messages.generated.ts";
import { el } from "./dom.ts";
import type { Mark, Marks } from "./marks.ts";
import { phaseLook } from "./phases.ts";
import type { Stretch } from "./time_window.ts";

const SNAP = 14; // pixels, within which a finger that meets the line chooses a mark

export class Timeline {
  readonly element: HTMLElement;
  private readonly bar = el("input", { type: "range", step: 0.01, "aria-label": "Time" });
  private readonly phases = el("div", { class: "phases" });
  private readonly lane = el("div", { class: "lane" });
  private readonly window = el("i", { class: "window" });
  private readonly words = el("p", { class: "words", hidden: true });
  private readonly buttons = new Map<Mark, HTMLButtonElement>();

  private span: Stretch = [0, 1]; // s, of the line
  private still = false; // under a mouse
  private finger = false;
  private all: readonly Mark[] = [];

  constructor(private readonly choose: (time: number) => void) {
    this.bar.addEventListener("input", () => this.chooseNear(this.bar.valueAsNumber));
    this.bar.addEventListener("pointerup", () => this.bar.blur()); // keys go on to the flight
    this.bar.addEventListener("keydown", () => (this.finger = false));
    this.bar.addEventListener("pointerdown", ({ pointerType }) => (this.finger = pointerType === "touch"));
    this.element = el("div", { class: "timeline" }, this.phases, this.window, this.bar, this.lane, this.words);
    this.element.addEventListener("pointerenter", ({ pointerType }) => (this.still = pointerType === "mouse"));
    this.element.addEventListener("pointerleave", () => (this.still = false));
  }

  /** Shows a flight so far; `value`: the chosen moment, or the present one. */
  update(flown: Stretch, shown: Stretch, value: number, marks: Marks, names: readonly Phase[]): void {
    if (!Number.isFinite(flown[0] + flown[1])) return;
    if (!this.still || flown[1] < this.span[1]) this.span = flown; // marks do not slide away under a mouse
    const [start, end] = this.span;
    Object.assign(this.bar, { min: String(start), max: String(end), value: String(value) });
    this.bar.setAttribute("aria-valuetext", `${value.toFixed(2)} s`);
    this.element.style.setProperty("--start", String(start));
    this.element.style.setProperty("--length", String(Math.max(end - start, 0.01)));
    place(this.window, Math.max(shown[0], start), Math.min(shown[1], end));
    this.showPhases(marks, names);
    this.showMarks(marks);
  }

  private chooseNear(time: number): void {
    const [start, end] = this.span;
    const reach = (SNAP * (end - start)) / this.bar.clientWidth;
    const gap = (mark: Mark): number => Math.abs(mark.time - time);
    const near = this.finger ? this.all.filter((mark) => gap(mark) < reach).sort((a, b) => gap(a) - gap(b))[0] : undefined;
    this.tell(near ?? null);
    this.choose(near?.time ?? time);
  }

  private tell(mark: Mark | null): void {
    this.words.hidden = mark === null;
    if (!mark) return;
    this.words.textContent = textOf(mark);
    this.words.style.setProperty("--at", String(mark.time));
  }

  private showPhases({ phases }: Marks, names: readonly Phase[]): void {
    while (this.phases.childElementCount > phases.length) this.phases.lastElementChild!.remove();
    phases.forEach(({ from, to, phase }, i) => {
      const piece = (this.phases.children[i] ?? this.phases.appendChild(el("i", {}))) as HTMLElement;
      place(piece, from, to);
      piece.style.backgroundColor = phaseLook(names[phase]).tint;
    });
  }

  private showMarks({ all }: Marks): void {
    this.all = all;
    for (const [mark, shown] of this.buttons) {
      if (all.includes(mark)) continue;
      shown.remove();
      this.buttons.delete(mark);
      this.words.hidden = true;
    }
    for (const mark of all) {
      const shown = this.buttons.get(mark) ?? this.newButton(mark);
      const words = textOf(mark);
      if (shown.ariaLabel !== words) shown.ariaLabel = words;
    }
  }

  private newButton(mark: Mark): HTMLButtonElement {
    const shown = el("button", { type: "button", class: `mark ${mark.kind}` });
    shown.style.setProperty("--at", String(mark.time));
    const tell = (on: boolean): void => this.tell(on ? mark : null);
    shown.addEventListener("pointerenter", () => tell(true));
    shown.addEventListener("focus", () => tell(true));
    shown.addEventListener("pointerleave", ({ pointerType }) => tell(pointerType !== "mouse"));
    shown.addEventListener("blur", () => tell(false));
    shown.addEventListener("click", () => {
      tell(true);
      this.choose(mark.time);
    });
    this.buttons.set(mark, shown);
    this.lane.append(shown);
    return shown;
  }
}

const textOf = ({ time, text }: Mark): string => `${time.toFixed(1)} s: ${text}`;

function place(piece: HTMLElement, from: number, to: number): void {
  piece.style.setProperty("--at", String(from));
  piece.style.setProperty("--for", String(to - from));
}
