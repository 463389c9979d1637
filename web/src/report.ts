// The report of a flight: plays it, and plots it over its whole time. Both are of one packed page, the flight's replay.

import uPlot from "uplot";

import "./style/report.css";

import { Layout, floats } from "./wire/frames.ts";
import type { FlightScene, FrameFieldName } from "./wire/messages.generated.ts";
import { bytes } from "./wire/replay.ts";

const HEIGHT = 190; // pixels of a plot
const [START, LONG] = [1, 5]; // s: a disturbed start sets no scale where at least so much is seen
const COLORS = ["--plot-1", "--plot-2", "--plot-3", "--plot-4"];
const VECTORS: [string, string, FrameFieldName, FrameFieldName?, string?][] = [
  ["Position (dashed: reference)", "m", "position", "reference", "ref"],
  ["Velocity", "m/s", "velocity"],
  ["Push (dashed: as the pilot uses it)", "N", "push", "pilot_push", "pilot"],
  ["Estimated disturbance", "N", "disturbance"],
  ["Wind", "m/s", "wind"],
];

interface Curve {
  label: string;
  color: string;
  deep: boolean; // half way from its colour to that of text
  dash: number[]; // none of a solid line
  values: Float32Array;
}

/** The packed page as text. */
async function unpacked(packed: string): Promise<string> {
  const stream = new Blob([bytes(packed)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

/** The columns of a flight by field. */
class Columns {
  private readonly layout: Layout;

  constructor(
    readonly scene: FlightScene,
    private readonly values: Float32Array,
  ) {
    this.layout = new Layout(scene.fields);
  }

  of(name: FrameFieldName): Float32Array[] {
    const { start, length } = this.layout.place(name);
    const { size } = this.layout;
    const count = this.values.length / size;
    return Array.from({ length }, (_, i) => Float32Array.from({ length: count }, (_, k) => this.values[k * size + start + i]));
  }
}

/** The components of a vector; with a suffix dashed and deeper, as they often lie on those of another one. */
function vector(columns: Columns, name: FrameFieldName, suffix = ""): Curve[] {
  const look = suffix ? { deep: true, dash: [4, 8] } : { deep: false, dash: [] };
  return columns.of(name).map((values, i) => ({ label: `${"xyz"[i]} ${suffix}`.trim(), color: COLORS[i], ...look, values }));
}

/** The thrusts, with a colour for each quadrotor, deep for its rotors 2 and 4, dashed for 3 and 4. */
function thrusts(columns: Columns): Curve[] {
  const owners = columns.scene.vehicle.quadrotors.flatMap((q, n) => q.rotors.map((_, i) => [n, i]));
  const label = (k: number): string => `rotor ${owners[k][0] + 1}.${owners[k][1] + 1}`;
  const color = (k: number): string => COLORS[owners[k][0] % COLORS.length];
  const look = (rotor: number) => ({ deep: rotor % 2 === 1, dash: rotor > 1 ? [6, 4] : [] });
  const curve = (values: Float32Array, k: number): Curve => ({ label: label(k), color: color(k), ...look(owners[k][1]), values });
  return columns.of("thrusts").map(curve);
}

/** The range of values of all curves between two samples, with some room. */
function range(curves: Curve[], time: Float32Array, [first, last]: [number, number]): [number, number] {
  const late = time[last] - time[first] > LONG ? time.findIndex((t) => t > START) : 0;
  const seen = curves.flatMap(({ values }) => [...values.subarray(Math.max(first, late), last + 1)].filter(Number.isFinite));
  const [low, high] = seen.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  const room = Math.max(0.06 * (high - low), 1e-3);
  return low <= high ? [low - room, high + room] : [0, 1];
}

function plot(title: string, unit: string, time: Float32Array, curves: Curve[], place: HTMLElement, seek: (time: number) => void): void {
  const ink = (name: string) => () => getComputedStyle(place).getPropertyValue(name);
  const axis = { stroke: ink("--soft"), grid: { stroke: ink("--line"), width: 1 }, ticks: { show: false } };
  const stroke = (c: Curve) => (c.deep ? () => `color-mix(in srgb, ${ink(c.color)()}, ${ink("--ink")()})` : ink(c.color));
  const series = curves.map((c) => ({ label: c.label, stroke: stroke(c), dash: c.dash, points: { show: false }, width: c.dash.length ? 1.2 : 1.6 }));
  const options: uPlot.Options = {
    title: `${title} [${unit}]`,
    width: place.clientWidth,
    height: HEIGHT,
    scales: { x: { time: false }, y: { range: (u) => range(curves, time, u.series[0].idxs ?? [0, time.length - 1]) } },
    cursor: { sync: { key: "flight", scales: ["x", null] }, drag: { x: true, y: false }, y: false },
    legend: { markers: { width: 2, dash: (_, i) => (curves[i - 1]?.dash.length ? "dashed" : "solid") } },
    axes: [{ ...axis, size: 30 }, { ...axis, size: 48 }],
    series: [{ label: "time [s]" }, ...series],
  };
  const drawn = new uPlot(options, [time, ...curves.map((c) => c.values)], place);
  drawn.over.addEventListener("click", () => {
    if (drawn.select.width < 2 && drawn.cursor.left !== undefined) seek(drawn.posToVal(drawn.cursor.left, "x"));
  });
  new ResizeObserver(() => drawn.setSize({ width: place.clientWidth, height: HEIGHT })).observe(place);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => drawn.redraw());
}

async function show(): Promise<void> {
  const [frame, place] = [document.querySelector<HTMLIFrameElement>("#flight iframe")!, document.getElementById("plots")!];
  const page = await unpacked(document.getElementById("packed")!.textContent);
  frame.srcdoc = page;
  const data = new DOMParser().parseFromString(page, "text/html").getElementById("flight")!.textContent;
  const { scene, frames } = JSON.parse(data) as { scene: FlightScene; frames: string };
  const columns = new Columns(scene, floats(bytes(frames)));
  const [time] = columns.of("time");
  const seek = (at: number): void => frame.contentWindow?.postMessage({ seek: at }, "*"); // a page from disk has no origin
  for (const [title, unit, name, other, suffix] of VECTORS) {
    const curves = [...vector(columns, name), ...(other ? vector(columns, other, suffix) : [])];
    if (curves.some(({ values }) => values.some((value) => value !== 0))) plot(title, unit, time, curves, place, seek);
  }
  plot("Thrusts of the rotors", "N", time, thrusts(columns), place, seek);
}

void show().finally(() => (document.getElementById("flight")!.dataset.shown = ""));
