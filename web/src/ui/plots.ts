// The four plots: push against threshold, reference against actual, thrusts, and what the observer believes.

import type uPlot from "uplot";

import { ahead } from "../view/quadrotor.ts";
import type { Graphics } from "../view/graphics.ts";
import type { Frame } from "../wire/frames.ts";
import type { Scene, Vector } from "../wire/protocol.ts";
import { choice } from "./dom.ts";
import { History } from "./history.ts";
import { phaseTint } from "./modes.ts";
import { band, level, Plot } from "./plot.ts";

const AXES = ["#c8372d", "#2c8a57", "#2f6fb0"];
const NAMES = ["x", "y", "z"];
const FRONTS = ["#e8641b", "#f29a4a", "#b5440a", "#f7b977"];
const REARS = ["#2f6fb0", "#6ea3d6", "#1b4a7d", "#9cc3e6"];

export class Plots {
  readonly history: History;
  threshold: Vector | null;
  private readonly all: { plot: Plot; columns: () => Float64Array[] }[];
  private difference = false;
  private turn = 0;

  constructor(
    private readonly scene: Scene,
    private readonly place: HTMLElement,
    private readonly graphics: Graphics,
  ) {
    this.history = new History(scene);
    this.threshold = scene.threshold ?? null;
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

  private of(field: string): Float64Array[] {
    return [0, 1, 2].map((i) => this.history.column(`${field}${i}`));
  }

  private pushes(): { plot: Plot; columns: () => Float64Array[] } {
    const felt = AXES.map((color, i) => ({ color, label: NAMES[i] }));
    const heard = AXES.map((color, i) => ({ color, dash: [4, 3], width: 1, ...(i === 2 && { label: "heard" }) }));
    const under = (plot: uPlot): void => {
      for (const limit of new Set(this.threshold ?? [])) {
        level(plot, limit, "#8d949e");
        level(plot, -limit, "#8d949e");
      }
    };
    const plot = new Plot({ title: "Push", unit: "N", curves: [...heard, ...felt], least: 1.2, under }, this.graphics);
    return { plot, columns: () => [...this.of("heard"), ...this.of("push")] };
  }

  private tracking(): { plot: Plot; columns: () => Float64Array[] } {
    const wanted = AXES.map((color, i) => ({ color, dash: [4, 3], width: 1, ...(i === 2 && { label: "ref." }) }));
    const actual = AXES.map((color, i) => ({ color, label: NAMES[i] }));
    const more = choice("What is shown", { place: "m", off: "off, cm" }, "place", (value) => {
      this.difference = value === "off";
    });
    const curves = [...wanted, ...actual];
    const plot = new Plot({ title: "Position", unit: "", curves, least: 0.5, more }, this.graphics);
    return { plot, columns: () => (this.difference ? this.off() : [...this.of("reference"), ...this.of("position")]) };
  }

  /** Reference and actual, less the reference [cm]. */
  private off(): Float64Array[] {
    const [wanted, actual] = [this.of("reference"), this.of("position")];
    const gaps = actual.map((column, i) => column.map((value, k) => 100 * (value - wanted[i][k])));
    return [...wanted.map((column) => new Float64Array(column.length)), ...gaps];
  }

  private thrusts(): { plot: Plot; columns: () => Float64Array[] } {
    const { quadrotors } = this.scene.vehicle;
    const curves = quadrotors.flatMap((q, n) =>
      q.rotors.map((_, i) => ({ color: (ahead(q, i) ? FRONTS : REARS)[n % 4], width: 1.2 })),
    );
    const most = new Set(quadrotors.flatMap((q) => q.rotors.map((r) => r.max_thrust)));
    const under = (plot: uPlot): void => {
      for (const limit of most) level(plot, limit, "#d5281b");
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

  private disturbance(): { plot: Plot; columns: () => Float64Array[] } {
    const curves = AXES.map((color, i) => ({ color, label: NAMES[i] }));
    const under = (plot: uPlot): void => {
      for (const { from, to, phase } of this.phases()) {
        const name = this.scene.phases[phase] ?? "";
        band(plot, from, to, phaseTint(name), name);
      }
    };
    const plot = new Plot({ title: "Disturbance, phase", unit: "N", curves, least: 1, under }, this.graphics);
    return { plot, columns: () => this.of("disturbance") };
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
