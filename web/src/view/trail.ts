// The path flown in the last seconds, and a vertical line from the vehicle to the floor.

import { BufferAttribute, BufferGeometry, Group, Line, LineBasicMaterial, LineSegments } from "three";

import type { Vector } from "../wire/messages.generated.ts";
import { palette } from "./palette.ts";

const KEPT = 225; // points of a piece
const STEP = 0.08; // m between points: few enough for a processor that draws them, and a path still looks round

const PIECES = 200; // of paths that stay
const PAST = 0.4; // opacity of a path of an earlier flight

/** A piece of a path. */
class Trail {
  readonly line: Line<BufferGeometry, LineBasicMaterial>;
  count = 0;
  private readonly places = new Float32Array(3 * KEPT);

  constructor() {
    const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(this.places, 3));
    this.line = new Line(shape, new LineBasicMaterial({ color: palette.path, transparent: true, opacity: 0.75 }));
    this.line.frustumCulled = false;
    this.clear();
  }

  get full(): boolean {
    return this.count === KEPT;
  }

  get end(): Vector {
    return [...this.places.subarray(3 * (this.count - 1), 3 * this.count)] as unknown as Vector;
  }

  clear(): void {
    this.count = 0;
    this.line.geometry.setDrawRange(0, 0);
  }

  add(place: Vector): void {
    const last = this.places.subarray(3 * (this.count - 2), 3 * (this.count - 2) + 3);
    const moved = this.count < 2 || Math.hypot(place[0] - last[0], place[1] - last[1], place[2] - last[2]) > STEP;
    if (moved && this.full) this.places.copyWithin(0, 3);
    else if (moved) this.count += 1;
    // the newest point is where the vehicle is now
    this.places.set(place, 3 * (this.count - 1));
    this.line.geometry.attributes["position"].needsUpdate = true;
    this.line.geometry.setDrawRange(0, this.count);
  }

  remove(): void {
    this.line.removeFromParent();
    this.line.geometry.dispose();
    this.line.material.dispose();
  }
}

/** The path flown: its last metres, or all of it and of the flights before if it is to stay. */
export class Trails {
  readonly group = new Group();
  stay = false;
  private now = new Trail();
  private past: Trail[] = [];

  constructor() {
    this.group.add(this.now.line);
  }

  /** Begins another path; those before are drawn paler, or removed unless they stay. */
  begin(): void {
    if (this.stay && this.now.count > 1) this.setAside();
    this.now.clear();
    for (const { line } of [...this.past, this.now]) line.material.color.set(palette.path);
    for (const { line } of this.past) line.material.opacity = PAST;
    this.prune();
  }

  add(place: Vector): void {
    if (this.stay && this.now.full) {
      const { end } = this.now;
      this.setAside();
      this.now.add(end);
    }
    this.now.add(place);
    this.prune();
  }

  private setAside(): void {
    this.past.push(this.now);
    this.now = new Trail();
    this.group.add(this.now.line);
  }

  private prune(): void {
    const most = this.stay ? PIECES : 0;
    while (this.past.length > most) this.past.shift()!.remove();
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
