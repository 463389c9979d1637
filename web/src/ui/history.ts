// The last seconds of the flight, in columns for the plots.

import type { Frame } from "../wire/frames.ts";
import type { FlightScene, FrameFieldName } from "../wire/messages.generated.ts";

export const SPAN = 20; // s
const RATE = 20; // samples/s that are kept
const CAPACITY = SPAN * RATE + 2;

export class History {
  readonly names: string[];
  private readonly columns = new Map<string, Float64Array>();
  private first = 0;
  private end = 0;

  constructor(scene: FlightScene) {
    const vectors = ["push", "pilot_push", "position", "reference", "disturbance"];
    const rotors = scene.vehicle.quadrotors.flatMap((q) => q.rotors).length;
    this.names = [
      "time",
      "phase",
      ...vectors.flatMap((name) => [0, 1, 2].map((i) => `${name}${i}`)),
      ...Array.from({ length: rotors }, (_, i) => `thrusts${i}`),
    ];
    for (const name of this.names) this.columns.set(name, new Float64Array(2 * CAPACITY));
  }

  get latest(): number {
    return this.end > this.first ? this.columns.get("time")![this.end - 1] : NaN;
  }

  clear(): void {
    this.first = this.end = 0;
  }

  /** Keeps a frame if it is due; a jump of time clears the history. True if there was a jump. */
  add(frame: Frame): boolean {
    const time = frame.scalar("time");
    const step = time - this.latest;
    const jumped = step < -1e-4 || step > 2;
    if (jumped) this.clear();
    if (!jumped && step < 1 / RATE - 1e-3) return false;
    this.write(frame);
    return jumped;
  }

  column(name: string): Float64Array {
    return this.columns.get(name)!.subarray(this.first, this.end);
  }

  private write(frame: Frame): void {
    if (this.end === 2 * CAPACITY) {
      for (const column of this.columns.values()) column.copyWithin(0, this.first, this.end);
      this.end -= this.first;
      this.first = 0;
    }
    for (const [name, column] of this.columns) column[this.end] = valueOf(frame, name);
    this.end += 1;
    if (this.end - this.first > CAPACITY) this.first += 1;
    const times = this.columns.get("time")!;
    while (times[this.end - 1] - times[this.first] > SPAN) this.first += 1;
  }
}

function valueOf(frame: Frame, name: string): number {
  if (name === "time" || name === "phase") return frame.scalar(name);
  const cut = name.search(/\d+$/);
  const field = name.slice(0, cut) as FrameFieldName;
  return frame.layout.has(field) ? frame.values[frame.layout.place(field).start + Number(name.slice(cut))] : NaN;
}
