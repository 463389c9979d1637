// One plot over time, with its title, unit, legend, and a choice where there is one.

import uPlot from "uplot";

import { color, type ColorName } from "./colors.ts";
import { el } from "./dom.ts";
import type { Graphics } from "../view/graphics.ts";
import { PlotCursor } from "./plot_cursor.ts";
import { listen, type PlotListener, selecting } from "./plot_gestures.ts";
import type { TimeWindow } from "./time_window.ts";

export interface Curve {
  name: string; // in the list of values
  color: ColorName;
  label?: string; // in the legend
  about?: string; // of a label that needs more words
  dash?: number[];
  width?: number;
  alpha?: number;
}

export interface PlotOptions {
  title: string;
  unit: string;
  curves: Curve[];
  least: number; // the smallest span of values that is shown
  fromZero?: boolean;
  headroom?: number; // above the curves, as a fraction of the span
  under?: (plot: uPlot) => void; // drawn below the curves
  more?: HTMLElement;
  keys?: HTMLElement[]; // in the legend, after those of the curves
  rows: number; // of values that stand below one another
}

const FONT = "10px system-ui, sans-serif";
const INK = () => color("--soft");
const HAIR = { stroke: () => color("--grid"), width: 1 };
const LEAST_AXIS = 34; // pixels, of the axis of values
const LAST_TIME = "0000 s"; // as wide as a label of time becomes

export class Plot {
  readonly card: HTMLElement;
  private readonly body = el("div", { class: "canvas" });
  private readonly plot: uPlot;
  private readonly cursor: PlotCursor;
  private readonly sizes = new ResizeObserver(() => this.fit());
  private dirty = true;

  constructor(
    look: PlotOptions,
    graphics: Graphics,
    private readonly window: TimeWindow,
    listener: PlotListener,
  ) {
    const keys = look.curves.flatMap((curve) => (curve.label ? [key(curve, curve.label)] : [])).concat(look.keys ?? []);
    const head = el("header", {}, el("b", {}, look.title), look.more ?? el("small", {}, look.unit));
    head.append(el("span", { class: "keys" }, ...keys));
    this.card = el("article", { class: "plot" }, head, this.body);
    const all = { ...options(look), ...selecting(window, listener) };
    if (look.under) all.hooks!.drawAxes = [look.under];
    const make = () => new uPlot(all, [[], ...look.curves.map(() => [])], this.body);
    this.plot = graphics === "light" ? onProcessor(make) : make();
    this.cursor = new PlotCursor(this.plot, look.curves, look.rows);
    listen(this.plot, window, listener);
    this.sizes.observe(this.body);
  }

  /** Takes it off the page, with what it hears of the window. */
  remove(): void {
    this.sizes.disconnect();
    this.plot.destroy();
    this.card.remove();
  }

  update(columns: uPlot.AlignedData): void {
    if (this.dirty) this.fit();
    const [min, max] = this.window.shown;
    this.plot.batch(() => {
      this.plot.setData(columns, false);
      this.plot.setScale("x", { min, max });
    });
    this.point();
  }

  /** Shows the values at the cursor. */
  point(): void {
    this.cursor.show(this.window.cursor);
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.body;
    this.dirty = width < 20;
    if (!this.dirty) this.plot.setSize({ width, height });
  }
}

/** Makes canvases that the processor draws: an emulated graphics card is slow at thin lines. */
function onProcessor<T>(make: () => T): T {
  const canvas = HTMLCanvasElement.prototype as { getContext: (kind: string, options?: object) => unknown };
  const { getContext } = canvas;
  canvas.getContext = function (kind) {
    return getContext.call(this, kind, { willReadFrequently: true });
  };
  try {
    return make();
  } finally {
    canvas.getContext = getContext;
  }
}

/** A curve's entry in the legend. */
export function key(curve: Curve, text: string): HTMLElement {
  // one letter is coloured itself; more have a piece of their line
  const named = text.length > 1;
  const mark = el(named ? "i" : "b", { class: curve.dash ? "dashed" : curve.name ? "" : "flight" }, named ? "" : text);
  mark.style.color = `var(${curve.color})`;
  if (curve.alpha) Object.assign(mark.style, { borderTopWidth: `${curve.width}px`, opacity: curve.alpha });
  return el("span", { title: curve.about }, mark, named ? text : "");
}

function options(look: PlotOptions): uPlot.Options {
  return {
    width: 200,
    height: 100,
    legend: { show: false },
    padding: [6, (plot) => Math.ceil(textWidth(plot, [LAST_TIME]) / 2) + 1, 0, 0],
    scales: { x: { time: false }, y: { range: (_, low, high) => span(low, high, look) } },
    axes: [
      {
        stroke: INK,
        font: FONT,
        grid: HAIR,
        ticks: { show: false },
        size: 18,
        gap: 2,
        values: (_, at) => at.map(seconds),
      },
      { stroke: INK, font: FONT, grid: HAIR, ticks: { show: false }, size: axisSize, gap: 3, space: 22 },
    ],
    series: [{}, ...look.curves.map(series)],
  };
}

/** The width that the labels of values need; kept while uPlot comes back to it, so that it comes to an end. */
function axisSize(plot: uPlot, labels: string[] | null, axis: number, cycle: number): number {
  if (cycle > 1) return (plot.axes[axis] as { _size?: number })._size ?? LEAST_AXIS;
  return Math.max(LEAST_AXIS, Math.ceil(textWidth(plot, labels ?? [])) + 7);
}

/** The width of the widest text [pixels of the page]. */
function textWidth({ ctx }: uPlot, texts: string[]): number {
  ctx.save();
  ctx.font = FONT;
  const widest = Math.max(0, ...texts.map((text) => ctx.measureText(text).width));
  ctx.restore();
  return widest;
}

function series({ color: name, dash, width = 1.5, alpha = 1 }: Curve): uPlot.Series {
  return { stroke: () => color(name), width, alpha, points: { show: false }, ...(dash && { dash }) };
}

const seconds = (value: number): string => (value < 0 ? "" : `${Number(value.toFixed(3))} s`);

/** The range to show: all values, with some room, and at least `least`, so that noise does not fill the plot. */
function span(low: number | null, high: number | null, options: PlotOptions): [number, number] {
  const { least, fromZero, headroom = 0.06 } = options;
  if (low === null || high === null || !Number.isFinite(low + high)) return [0, least];
  const missing = Math.max(least - (high - low), 0) / 2;
  const size = Math.max(high - low, least);
  const [below, above] = [0.06 * size, headroom * size];
  return fromZero ? [0, Math.max(high, least) + above] : [low - missing - below, high + missing + above];
}

/** A dashed level line across a plot. */
export function level(plot: uPlot, value: number, name: ColorName): void {
  const y = plot.valToPos(value, "y", true);
  const { left, top, width, height } = plot.bbox;
  if (y < top || y > top + height) return;
  const { ctx } = plot;
  ctx.save();
  ctx.strokeStyle = color(name);
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(left, y);
  ctx.lineTo(left + width, y);
  ctx.stroke();
  ctx.restore();
}

/** A coloured band over a stretch of time, with its name. */
export function band(plot: uPlot, from: number, to: number, tint: string, name: string): void {
  const { left, top, width, height } = plot.bbox;
  const place = (time: number) => Math.min(Math.max(plot.valToPos(time, "x", true), left), left + width);
  const [a, b] = [place(from), place(to)];
  const { ctx } = plot;
  ctx.save();
  ctx.fillStyle = tint;
  ctx.fillRect(a, top, b - a, height);
  ctx.fillStyle = INK();
  ctx.textAlign = "left";
  ctx.font = `${10 * devicePixelRatio}px system-ui, sans-serif`;
  if (b - a > ctx.measureText(name).width + 8) ctx.fillText(name, a + 4, top + 11 * devicePixelRatio);
  ctx.restore();
}
