// Frames: float32, little endian, laid out as the scene's `fields` say.

import { type FrameFieldName, JUMPING_FIELDS, type Quaternion, type Vector } from "./messages.generated.ts";

/** Where each field of a frame lies. */
export class Layout {
  readonly size: number;
  private readonly places = new Map<FrameFieldName, { start: number; length: number }>();

  constructor(fields: readonly (readonly [FrameFieldName, number])[]) {
    let start = 0;
    for (const [name, length] of fields) {
      this.places.set(name, { start, length });
      start += length;
    }
    this.size = start;
  }

  has(name: FrameFieldName): boolean {
    return this.places.has(name);
  }

  place(name: FrameFieldName): { start: number; length: number } {
    return this.places.get(name) ?? { start: 0, length: 0 };
  }

  /** The frame in a message, and its ghost's; null if its size is another one, as when it was sent before a new scene. */
  decode(bytes: ArrayBuffer): Frame | null {
    return [4, 8].includes(bytes.byteLength / this.size) ? new Frame(this, floats(bytes)) : null;
  }

  /** The fields that may be interpolated between two frames. */
  smooth(): FrameFieldName[] {
    return [...this.places.keys()].filter((name) => !JUMPING_FIELDS.includes(name));
  }
}

/** One moment of the flight; a field that is not in it reads as zeros. */
export class Frame {
  constructor(
    readonly layout: Layout,
    readonly values: Float32Array,
  ) {}

  /** Whether position and attitude are valid; those of a flight that diverged may not be. */
  get drawable(): boolean {
    const numbers = [...this.vector("position"), ...this.attitude];
    return numbers.every(Number.isFinite) && Math.hypot(...this.attitude) > 0.5;
  }

  scalar(name: FrameFieldName): number {
    const { start, length } = this.layout.place(name);
    return length ? this.values[start] : 0;
  }

  vector(name: FrameFieldName): Vector {
    const { start, length } = this.layout.place(name);
    const v = this.values;
    return length === 3 ? [v[start], v[start + 1], v[start + 2]] : [0, 0, 0];
  }

  list(name: FrameFieldName): Float32Array {
    const { start, length } = this.layout.place(name);
    return this.values.subarray(start, start + length);
  }

  /** The ghost at the same moment, if one flies along: its values come after the flight's own. */
  get ghost(): Frame | null {
    const { size } = this.layout;
    return this.values.length === 2 * size ? new Frame(this.layout, this.values.subarray(size)) : null;
  }

  get pose(): { position: Vector; attitude: Quaternion } {
    return { position: this.vector("position"), attitude: this.attitude };
  }

  get attitude(): Quaternion {
    const { start, length } = this.layout.place("attitude");
    const v = this.values;
    return length === 4 ? [v[start], v[start + 1], v[start + 2], v[start + 3]] : [1, 0, 0, 0];
  }
}

/** Float32 numbers of little-endian bytes, on a machine of any byte order. */
export function floats(bytes: ArrayBuffer): Float32Array {
  if (LITTLE) return new Float32Array(bytes);
  const view = new DataView(bytes);
  return Float32Array.from({ length: bytes.byteLength / 4 }, (_, i) => view.getFloat32(4 * i, true));
}

const LITTLE = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1;

/** A frame between two: `fraction` 0 is the first, 1 the second. Flags jump, all else is interpolated. */
export function between(a: Frame, b: Frame, fraction: number): Frame {
  const values = Float32Array.from(a.values);
  for (const name of a.layout.smooth()) {
    const { start, length } = a.layout.place(name);
    const sign = name === "attitude" && opposed(a, b, start) ? -1 : 1;
    for (let i = start; i < start + length; i++) {
      values[i] = (1 - fraction) * a.values[i] + fraction * sign * b.values[i];
    }
    if (name === "attitude") normalise(values, start);
  }
  return new Frame(a.layout, values);
}

function opposed(a: Frame, b: Frame, start: number): boolean {
  let product = 0;
  for (let i = start; i < start + 4; i++) product += a.values[i] * b.values[i];
  return product < 0;
}

function normalise(values: Float32Array, start: number): void {
  const size = Math.hypot(...values.subarray(start, start + 4)) || 1;
  for (let i = start; i < start + 4; i++) values[i] /= size;
}
