// The four plots: push and threshold, position and reference, thrusts, estimated disturbance and phases.

import type uPlot from "uplot";

import { ahead } from "../view/rotors.ts";
import type { Graphics } from "../view/graphics.ts";
import type { Frame } from "../wire/frames.ts";
import type { FlightScene, Vector } from "../wire/messages.generated.ts";
import type { ColorName } from "./colors.ts";
import { choice } from "./dom.ts";
import { History } from "./history.ts";
import { phaseTint } from "./phases.ts";
import { band, level, Plot } from "./plot.ts";

const AXES: ColorName[] = ["--axis-x", "--axis-y", "--axis-z"];
const NAMES = ["x", "y", "z"];
const FRONTS: ColorName[] = ["--front-1", "--front-2", "--front-3", "--front-4"];
const REARS: ColorName[] = ["--rear-1", "--rear-2", "--rear-3", "--rear-4"];

/** A plot, and the columns that it shows. */
interface PlotWithData {
  plot: Plot;
  columns: () => Float64Array[];
}

export class Plots {
  readonly history: History;
  threshold: Vector;
  private readonly all: PlotWithData[];
  private asError = false;
  private turn = 0;

  constructor(
    private readonly scene: FlightScene,
    private readonly place: HTMLElement,
    private readonly graphics: Graphics,
  ) {
    this.history = new History(scene);
    this.threshold = scene.threshold;
    this.all = [this.pushes(), this.tracking(), this.thrusts(), this.disturbance()];
    place.replaceChildren(...this.all.map(({ plot }) => plot.card));
  }

  add(frame: Frame): boolean {
    return this.history.add(frame);
  }

  /** Draws the plot whose turn it is, so that no picture waits for all of them. */
  draw(): void {
    if (this.place.hidden || !Number.isFinite(this.history.latest)) return;
    this.turn = (this.turn + 1) % this.all.length;
    const { plot, columns } = this.all[this.turn];
    plot.update(this.history.latest, [this.history.column("time"), ...columns()]);
  }

  private vector(field: string): Float64Array[] {
    return [0, 1, 2].map((i) => this.history.column(`${field}${i}`));
  }

  private pushes(): PlotWithData {
    const actual = AXES.map((color, i) => ({ color, label: NAMES[i] }));
    const pilot = AXES.map((color, i) => ({ color, dash: [4, 3], width: 1, ...(i === 2 && { label: "pilot" }) }));
    const under = (plot: uPlot): void => {
      for (const limit of new Set(this.threshold)) {
        level(plot, limit, "--level");
        level(plot, -limit, "--level");
      }
    };
    const look = { title: "Push", unit: "N", curves: [...pilot, ...actual], least: 1.2, under };
    const plot = new Plot(look, this.graphics);
    return { plot, columns: () => [...this.vector("pilot_push"), ...this.vector("push")] };
  }

  private tracking(): PlotWithData {
    const reference = AXES.map((color, i) => ({ color, dash: [4, 3], width: 1, ...(i === 2 && { label: "ref." }) }));
    const actual = AXES.map((color, i) => ({ color, label: NAMES[i] }));
    const more = choice("What is shown", { position: "m", error: "\u0394 cm" }, "position", (value) => {
      this.asError = value === "error";
    });
    const curves = [...reference, ...actual];
    const plot = new Plot({ title: "Position", unit: "", curves, least: 0.5, more }, this.graphics);
    const positions = () => [...this.vector("reference"), ...this.vector("position")];
    return { plot, columns: () => (this.asError ? this.error() : positions()) };
  }

  /** Reference and position minus the reference [cm]. */
  private error(): Float64Array[] {
    const [reference, actual] = [this.vector("reference"), this.vector("position")];
    const gaps = actual.map((column, i) => column.map((value, k) => 100 * (value - reference[i][k])));
    return [...reference.map((column) => new Float64Array(column.length)), ...gaps];
  }

  private thrusts(): PlotWithData {
    const { quadrotors } = this.scene.vehicle;
    const curves = quadrotors.flatMap((q, n) =>
      q.rotors.map((_, i) => ({ color: (ahead(q, i) ? FRONTS : REARS)[n % 4], width: 1.2 })),
    );
    const limits = new Set(quadrotors.flatMap((q) => q.rotors.map((r) => r.max_thrust)));
    const under = (plot: uPlot): void => {
      for (const limit of limits) level(plot, limit, "--red");
    };
    const labelled = curves.map((c, i) => ({
      ...c,
      ...(i === 0 && { label: "front" }),
      ...(i === 1 && { label: "rear" }),
    }));
    const look = { title: "Thrusts", unit: "N", curves: labelled, least: 4, fromZero: true, under };
    const plot = new Plot(look, this.graphics);
    return { plot, columns: () => curves.map((_, i) => this.history.column(`thrusts${i}`)) };
  }

  private disturbance(): PlotWithData {
    const curves = AXES.map((color, i) => ({ color, label: NAMES[i] }));
    const under = (plot: uPlot): void => {
      for (const { from, to, phase } of this.phases()) {
        const name = this.scene.phases[phase];
        band(plot, from, to, phaseTint(name), name);
      }
    };
    const look = { title: "Disturbance, phase", unit: "N", curves, least: 1, headroom: 0.3, under }; // for the names
    const plot = new Plot(look, this.graphics);
    return { plot, columns: () => this.vector("disturbance") };
  }

  /** Stretches of time with one phase each. */
  private phases(): { from: number; to: number; phase: number }[] {
    const [times, phases] = [this.history.column("time"), this.history.column("phase")];
    const found: { from: number; to: number; phase: number }[] = [];
    times.forEach((time, i) => {
      const last = found.at(-1);
      if (last) last.to = time;
      if (last?.phase !== phases[i]) found.push({ from: time, to: time, phase: phases[i] });
    });
    return found;
  }
}
