// The four plots: push and threshold, position and reference, thrusts, estimated disturbance and phases.

import type uPlot from "uplot";

import { ahead } from "../view/rotors.ts";
import type { Graphics } from "../view/graphics.ts";
import type { Vector } from "../wire/messages.generated.ts";
import type { FlownScene } from "../wire/source.ts";
import type { ColorName } from "./colors.ts";
import { choice } from "./dom.ts";
import { GHOST, type History } from "./history.ts";
import type { Marks } from "./marks.ts";
import { phaseLook } from "./phases.ts";
import { band, type Curve, key, level, Plot, type PlotOptions } from "./plot.ts";
import type { TimeWindow } from "./time_window.ts";

const AXES: ColorName[] = ["--axis-x", "--axis-y", "--axis-z"];
const NAMES = ["x", "y", "z"];
const DASHED = { dash: [4, 3], width: 1 };
const PALE = { width: 4, alpha: 0.4 };
const MOST = 6; // curves of a plot beside which those of a ghost can be read
const GREY: Curve = { name: "", color: "--soft" };
const FRONTS: ColorName[] = ["--front-1", "--front-2", "--front-3", "--front-4"];
const REARS: ColorName[] = ["--rear-1", "--rear-2", "--rear-3", "--rear-4"];

/** A plot, and the columns that it shows. */
interface PlotWithData {
  plot: Plot;
  columns: () => Column[];
}
type Column = Float64Array | (number | null)[];

/** The columns of a plot's curves, by that of a name. */
type Columns = (of: (name: string) => Float64Array) => Float64Array[];

const vector = (of: Parameters<Columns>[0], field: string): Float64Array[] => [0, 1, 2].map((i) => of(`${field}${i}`));

/** A curve for each axis. */
const along = (look: (name: string, i: number) => Partial<Curve>): Curve[] =>
  AXES.map((color, i) => ({ name: NAMES[i], color, ...look(NAMES[i], i) }));

export class Plots {
  threshold: Vector;
  private readonly all: PlotWithData[];
  private turn = 0;

  constructor(
    private readonly scene: FlownScene,
    private readonly place: HTMLElement,
    private readonly graphics: Graphics,
    private readonly history: History,
    private readonly window: TimeWindow,
    private readonly marks: Marks,
    private readonly chose: (time: number) => void,
    public asError = false,
  ) {
    this.threshold = scene.threshold;
    this.all = [this.pushes(), this.tracking(), this.thrusts(), this.disturbance()];
    place.replaceChildren(...this.all.map(({ plot }) => plot.card));
  }

  remove(): void {
    for (const { plot } of this.all) plot.remove();
  }

  /** Draws the plot whose turn it is, so that no picture waits for all of them. */
  draw(): void {
    if (this.place.hidden || !Number.isFinite(this.history.flown[1])) return;
    this.turn = (this.turn + 1) % this.all.length;
    const { plot, columns } = this.all[this.turn];
    this.history.show(this.window.shown);
    plot.update([this.history.column("time"), ...columns()]);
  }

  /** Shows the values at the cursor in all plots. */
  point(): void {
    for (const { plot } of this.all) plot.point();
  }

  /** A plot; where a ghost flies along, its curves in place of dashed ones, paler and below, if they are few. */
  private plot(look: PlotOptions, columns: Columns): PlotWithData {
    const looked = (): void => this.point();
    const make = (all: PlotOptions): Plot => new Plot(all, this.graphics, this.window, { looked, chose: this.chose });
    const of = (whose: string): Float64Array[] => columns((name) => this.history.column(whose + name));
    if (!this.scene.ghost || look.curves.length > MOST) return { plot: make(look), columns: () => of("") };
    const solid = look.curves.map(({ dash }) => !dash);
    const own = look.curves.filter((_, i) => solid[i]);
    const pale = own.map((curve) => ({ ...curve, ...PALE, name: GHOST + curve.name, label: "" }));
    const keys = [key(GREY, "now"), key({ ...GREY, ...PALE }, "ghost")];
    const plot = make({ ...look, curves: [...pale, ...own], keys });
    const shown = (whose: string): Float64Array[] => of(whose).filter((_, i) => solid[i]);
    const present = (column: Float64Array): Column => Array.from(column, (one) => (Number.isNaN(one) ? null : one));
    return { plot, columns: () => [...shown(GHOST).map(present), ...shown("")] };
  }

  private pushes(): PlotWithData {
    const pilot = along((name, i) => ({ ...DASHED, name: `pilot ${name}`, ...(i === 2 && { label: "pilot" }) }));
    const actual = along((label) => ({ label }));
    const under = (plot: uPlot): void => {
      for (const limit of new Set(this.threshold)) {
        level(plot, limit, "--level");
        level(plot, -limit, "--level");
      }
    };
    const look = { title: "Push", unit: "N", curves: [...pilot, ...actual], least: 1.2, under, rows: 3 };
    return this.plot(look, (of) => [...vector(of, "pilot_push"), ...vector(of, "push")]);
  }

  private tracking(): PlotWithData {
    const reference = along((name, i) => ({ ...DASHED, name: `ref. ${name}`, ...(i === 2 && { label: "ref." }) }));
    const actual = along((label) => ({ label }));
    const now = this.asError ? "error" : "position";
    const more = choice("What is shown", { position: "m", error: "\u0394 cm" }, now, (value) => {
      this.asError = value === "error";
    });
    const look = { title: "Position", unit: "", curves: [...reference, ...actual], least: 0.5, more, rows: 3 };
    return this.plot(look, (of) => {
      const [wanted, flown] = [vector(of, "reference"), vector(of, "position")];
      if (!this.asError) return [...wanted, ...flown];
      const gaps = flown.map((column, i) => column.map((value, k) => 100 * (value - wanted[i][k])));
      return [...wanted.map((column) => new Float64Array(column.length)), ...gaps];
    });
  }

  private thrusts(): PlotWithData {
    const { quadrotors } = this.scene.vehicle;
    const curves = quadrotors.flatMap((q, n) =>
      q.rotors.map((_, i) => ({ name: `${4 * n + i + 1}`, color: (ahead(q, i) ? FRONTS : REARS)[n % 4], width: 1.2 })),
    );
    const limits = new Set(quadrotors.flatMap((q) => q.rotors.map((r) => r.max_thrust)));
    const under = (plot: uPlot): void => {
      for (const limit of limits) level(plot, limit, "--red");
    };
    const labelled = curves.map((c, i) => ({
      ...c,
      ...(i === 0 && { label: "front", about: "Rotors ahead of the middle of their quadrotor, left or right" }),
      ...(i === 1 && { label: "rear", about: "Rotors behind the middle of their quadrotor, left or right" }),
    }));
    const look = { title: "Thrusts", unit: "N", curves: labelled, least: 4, fromZero: true, under, rows: 4 };
    return this.plot(look, (of) => curves.map((_, i) => of(`thrusts${i}`)));
  }

  private disturbance(): PlotWithData {
    const curves = along((label) => ({ label }));
    const under = (plot: uPlot): void => {
      for (const { from, to, phase } of this.marks.phases) {
        const { tint, text } = phaseLook(this.scene.phases[phase]);
        band(plot, from, to, tint, text);
      }
    };
    const look = { title: "Disturbance, phase", unit: "N", curves, least: 1, under, rows: 3 };
    return this.plot({ ...look, headroom: 0.3 }, (of) => vector(of, "disturbance")); // for the names
  }
}
