// The path flown in the last seconds, and a vertical line from the vehicle to the floor.

import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial, LineSegments } from "three";

import type { Vector } from "../wire/messages.generated.ts";
import { palette } from "./palette.ts";

const KEPT = 600;
const STEP = 0.03; // m between points

export class Trail {
  readonly line: Line;
  private readonly places = new Float32Array(3 * KEPT);
  private count = 0;

  constructor() {
    const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(this.places, 3));
    this.line = new Line(shape, new LineBasicMaterial({ color: palette.path, transparent: true, opacity: 0.75 }));
    this.line.frustumCulled = false;
    this.clear();
  }

  clear(): void {
    this.count = 0;
    this.line.geometry.setDrawRange(0, 0);
  }

  add(place: Vector): void {
    const last = this.places.subarray(3 * (this.count - 2), 3 * (this.count - 2) + 3);
    const moved = this.count < 2 || Math.hypot(place[0] - last[0], place[1] - last[1], place[2] - last[2]) > STEP;
    if (moved && this.count === KEPT) this.places.copyWithin(0, 3);
    else if (moved) this.count += 1;
    // the newest point is where the vehicle is now
    this.places.set(place, 3 * (this.count - 1));
    this.line.geometry.attributes["position"].needsUpdate = true;
    this.line.geometry.setDrawRange(0, this.count);
  }
}

export class Plumb {
  readonly line: LineSegments;
  private readonly ends = new Float32Array(6);

  constructor(private readonly floor: number) {
    const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(this.ends, 3));
    this.line = new LineSegments(shape, new LineBasicMaterial({ color: palette.path, transparent: true, opacity: 0.5 }));
    this.line.frustumCulled = false;
  }

  place([x, y, z]: Vector): void {
    this.ends.set([x, y, z, x, y, this.floor]);
    this.line.geometry.attributes["position"].needsUpdate = true;
  }
}
