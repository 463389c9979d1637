// The line at the cursor's time over a plot, and the values of its curves there.

import type uPlot from "uplot";

import type { ColorName } from "./colors.ts";
import { el } from "./dom.ts";
import { indexOf } from "./history.ts";

/** A curve's name in the list of values, and its colour. */
export interface NamedCurve {
  name: string;
  color: ColorName;
}

export class PlotCursor {
  private readonly line = el("div", { class: "cursor", hidden: true });
  private readonly time = el("b", {});
  private readonly values: HTMLElement[];

  constructor(
    private readonly plot: uPlot,
    curves: readonly NamedCurve[],
    rows: number, // of values that stand below one another
  ) {
    this.values = curves.map(() => el("span", {}));
    const entries = curves.map(({ name, color }, i) => {
      const entry = el("div", {}, el("i", {}, name), this.values[i]);
      entry.style.color = `var(${color})`;
      return entry;
    });
    const list = el("div", { class: "list" }, ...entries);
    list.style.gridTemplateRows = `repeat(${rows}, auto)`;
    this.line.append(el("div", { class: "values" }, this.time, list));
    plot.over.append(this.line);
  }

  /** Shows the cursor at a time, if that is in view. */
  show(time: number | null): void {
    const { data, scales } = this.plot;
    const { min, max } = scales["x"];
    const last = data[0].length - 1;
    const inView = time !== null && last >= 0 && min !== undefined && max !== undefined && time >= min && time <= max;
    this.line.hidden = !inView || time < data[0][0] || time > data[0][last] + 0.1;
    if (this.line.hidden) return;
    const x = this.plot.valToPos(time!, "x");
    this.line.style.transform = `translateX(${x}px)`;
    this.line.classList.toggle("left", x > this.plot.over.clientWidth / 2);
    this.time.textContent = `${time!.toFixed(2)} s`;
    const k = nearest(data[0], time!);
    this.values.forEach((value, i) => (value.textContent = textOf(data[i + 1][k])));
  }
}

/** The index of the nearest of ascending numbers. */
export function nearest(ascending: ArrayLike<number>, value: number): number {
  const after = Math.min(indexOf(ascending, value), ascending.length - 1);
  const before = Math.max(after - 1, 0);
  return value - ascending[before] < ascending[after] - value ? before : after;
}

function textOf(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  const digits = Math.abs(value) < 100 ? 2 : 0;
  return (Number(value.toFixed(digits)) + 0).toFixed(digits).replace("-", "\u2212"); // no −0
}
