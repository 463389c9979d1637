// The flight so far, in columns for the plots.

import type { Frame } from "../wire/frames.ts";
import type { FrameFieldName } from "../wire/messages.generated.ts";
import type { FlownScene } from "../wire/source.ts";
import type { Stretch } from "./time_window.ts";

export const GHOST = "ghost "; // begins the names of a ghost's columns
const RATE = 20; // samples/s that are kept
const FIRST_SIZE = 1024; // samples, doubled when they are taken
const MOST = 16 * FIRST_SIZE; // samples, of which the older half is then thinned
const LOST = 2; // s without a frame, as after a lost connection: what is older is forgotten

export class History {
  private readonly columns = new Map<string, Float64Array>();
  private length = 0;
  private shown: Stretch = [0, 0]; // of indices

  constructor(private scene: FlownScene) {
    const vectors = ["push", "pilot_push", "position", "reference", "disturbance"];
    const rotors = scene.vehicle.quadrotors.flatMap((q) => q.rotors).length;
    const names = [
      "time",
      ...vectors.flatMap((name) => [0, 1, 2].map((i) => `${name}${i}`)),
      ...Array.from({ length: rotors }, (_, i) => `thrusts${i}`),
    ];
    for (const name of [...names, ...names.slice(1).map((one) => GHOST + one)]) {
      this.columns.set(name, new Float64Array(FIRST_SIZE));
    }
  }

  /** Takes a scene whose frames continue this flight, or one that its ghost flew until now; else false. */
  continue(scene: FlownScene): boolean {
    const { ghost: before } = this.scene;
    const begins = scene.ghost?.begun !== before?.begun;
    const swapped = !begins && scene.ghost?.swaps !== before?.swaps;
    const known = swapped || scene.mission === this.scene.mission;
    if (!known || String(scene.fields) !== String(this.scene.fields)) return false;
    this.scene = scene;
    if (scene.ghost && begins) this.copyGhost();
    if (swapped) this.swapGhost();
    return true;
  }

  /** First and last time [s]. */
  get flown(): Stretch {
    const times = this.columns.get("time")!;
    return this.length ? [times[0], times[this.length - 1]] : [NaN, NaN];
  }

  /**
   * Keeps a frame if it is due. What is later than it is forgotten, and all if much is missing before it; true if
   * anything is.
   */
  add(frame: Frame): boolean {
    const time = frame.scalar("time");
    const step = time - this.flown[1];
    const jumped = step > LOST || step < -1e-4;
    if (jumped) this.length = step > 0 ? 0 : this.index(time);
    else if (step < 1 / RATE - 1e-3) return false;
    this.write(frame);
    return jumped;
  }

  /** Lets columns be those of a stretch of time, and one sample more at either end. */
  show([from, to]: Stretch): void {
    this.shown = [Math.max(this.index(from) - 1, 0), Math.min(this.index(to) + 1, this.length)];
  }

  column(name: string): Float64Array {
    return this.columns.get(name)!.subarray(...this.shown);
  }

  /** A ghost begins, which has flown as the flight has. */
  private copyGhost(): void {
    for (const name of this.ghosts()) this.columns.set(name, this.columns.get(name.slice(GHOST.length))!.slice());
  }

  private swapGhost(): void {
    for (const name of this.ghosts()) {
      const own = name.slice(GHOST.length);
      const column = this.columns.get(name)!;
      this.columns.set(name, this.columns.get(own)!).set(own, column);
    }
  }

  /** The names of a ghost's columns. */
  private ghosts(): string[] {
    return [...this.columns.keys()].filter((name) => name.startsWith(GHOST));
  }

  /** The first sample that is not before a time. */
  private index(time: number): number {
    return indexOf(this.columns.get("time")!.subarray(0, this.length), time);
  }

  /** Keeps every second sample of the older half: an hour takes the memory of a quarter of it. */
  private thin(): void {
    for (const column of this.columns.values()) {
      for (let i = 0; i < MOST / 4; i++) column[i] = column[2 * i];
      column.copyWithin(MOST / 4, MOST / 2);
    }
    this.length = (3 / 4) * MOST;
  }

  private write(frame: Frame): void {
    if (this.length === MOST) this.thin();
    for (const [name, column] of this.columns) {
      const roomy = this.length < column.length ? column : grown(column);
      roomy[this.length] = valueOf(frame, name);
      this.columns.set(name, roomy);
    }
    this.length += 1;
  }
}

/** The first of ascending numbers that is not below a value; their count if all are. */
export function indexOf(ascending: ArrayLike<number>, value: number): number {
  let [low, high] = [0, ascending.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ascending[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

function grown(column: Float64Array): Float64Array {
  const larger = new Float64Array(2 * column.length);
  larger.set(column);
  return larger;
}

function valueOf(frame: Frame | null, name: string): number {
  if (!frame) return NaN;
  if (name === "time") return frame.scalar(name);
  if (name.startsWith(GHOST)) return valueOf(frame.ghost, name.slice(GHOST.length));
  const cut = name.search(/\d+$/);
  const field = name.slice(0, cut) as FrameFieldName;
  return frame.layout.has(field) ? frame.values[frame.layout.place(field).start + Number(name.slice(cut))] : NaN;
}
