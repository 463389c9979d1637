// What a person does over a plot: point at a moment, choose one, zoom in time by wheel, drag or two fingers.

import type uPlot from "uplot";

import { pinched, type Stretch, type TimeWindow, zoomed } from "./time_window.ts";

const WHEEL = 0.0015; // of the logarithm of the zoom, per pixel that the wheel scrolls
const LINE = 16; // pixels, of a wheel that counts in lines

/** What plots and timeline do when a person chooses a moment or looks at another stretch. */
export interface PlotListener {
  looked(): void;
  chose(time: number): void;
}

/** Lets a plot's area zoom and point; `window` is that of all plots. */
export function listen(plot: uPlot, window: TimeWindow, listener: PlotListener): void {
  const { over } = plot;
  const timeAt = (x: number): number => timeUnder(over, window, x);
  const look = (time: number | null): void => {
    window.hovered = time;
    listener.looked();
  };
  over.addEventListener("pointermove", ({ clientX, pointerType }) => {
    if (pointerType === "mouse") look(timeAt(clientX));
  });
  over.addEventListener("pointerleave", () => look(null));
  over.addEventListener("pointerdown", ({ pointerType }) => {
    if (pointerType === "mouse") holdUntilUp(window);
  });
  over.addEventListener("click", ({ clientX }) => listener.chose(timeAt(clientX)));
  over.addEventListener("dblclick", () => {
    window.follow();
    window.choose(null);
    look(null);
  });
  over.addEventListener("wheel", (event) => {
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) return; // scrolls from plot to plot
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE : 1);
    window.zoom(zoomed(window.shown, timeAt(event.clientX), Math.exp(WHEEL * pixels)));
    listener.looked();
  });
  listenToFingers(over, window, timeAt, () => listener.looked());
}

/** The options of uPlot by which a drag selects a stretch, which becomes the one that is shown. */
export function selecting(window: TimeWindow, listener: PlotListener): Pick<uPlot.Options, "cursor" | "hooks"> {
  const select = (plot: uPlot): void => {
    const { left, width } = plot.select;
    if (width <= 0) return;
    window.zoom([plot.posToVal(left, "x"), plot.posToVal(left + width, "x")]);
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    listener.looked();
  };
  return {
    cursor: {
      x: false,
      y: false,
      points: { show: false },
      drag: { x: true, y: false, dist: 4, setScale: false },
      bind: { dblclick: () => null },
    },
    hooks: { setSelect: [select] },
  };
}

/** The time at a place of the page; not as the plot was last drawn, which may be before a zoom. */
function timeUnder(over: HTMLElement, { shown: [from, to] }: TimeWindow, x: number): number {
  const { left, width } = over.getBoundingClientRect();
  return from + ((to - from) * (x - left)) / width;
}

function holdUntilUp(window: TimeWindow): void {
  window.hold();
  // after the mouse's own event, by which uPlot ends its drag
  document.addEventListener("mouseup", () => setTimeout(() => window.release()), { once: true });
}

/** Two fingers stretch time between them; one scrolls from plot to plot, as the browser does it. */
function listenToFingers(over: HTMLElement, window: TimeWindow, timeAt: (x: number) => number, looked: () => void): void {
  let times: Stretch | null = null; // under the two fingers, when they came down
  const start = (event: TouchEvent): void => {
    times = null;
    if (event.touches.length !== 2) return;
    event.preventDefault();
    window.hold();
    const [left, right] = places(event);
    times = [timeAt(left), timeAt(right)];
  };
  const move = (event: TouchEvent): void => {
    if (!times || event.touches.length !== 2) return;
    event.preventDefault();
    const { left, width } = over.getBoundingClientRect();
    const [a, b] = places(event);
    window.release();
    window.zoom(pinched(times, [(a - left) / width, (b - left) / width]));
    looked();
  };
  const end = (): void => {
    if (times) window.release();
    times = null;
  };
  over.addEventListener("touchstart", start, { passive: false });
  over.addEventListener("touchmove", move, { passive: false });
  over.addEventListener("touchend", end);
  over.addEventListener("touchcancel", end);
}

/** Where the two fingers are, from the left. */
function places({ touches }: TouchEvent): Stretch {
  const [a, b] = [touches[0].clientX, touches[1].clientX];
  return [Math.min(a, b), Math.max(a, b)];
}
