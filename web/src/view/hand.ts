// The hand on the beam: where it holds, the spring to the cursor, and the zone in which a pull moves nothing.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  EdgesGeometry,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
} from "three";

import { palette } from "./palette.ts";

const COILS = 14;
const WIDTH = 0.035; // m, of the spring's zigzag

export class HandMarker {
  readonly group = new Group();
  private readonly point: Mesh;
  private readonly end: Mesh;
  private readonly spring: Line;
  private readonly zone = new Group();
  private readonly places = new Float32Array(3 * (2 * COILS + 2));

  constructor() {
    const paint = new MeshBasicMaterial({ color: palette.hand, depthTest: false, transparent: true, opacity: 0.9 });
    this.point = new Mesh(new SphereGeometry(0.03, 14, 10), paint);
    this.end = new Mesh(new SphereGeometry(0.022, 12, 8), paint);
    const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(this.places, 3));
    this.spring = new Line(shape, new LineBasicMaterial({ color: palette.hand, depthTest: false, transparent: true }));
    this.spring.frustumCulled = false;
    this.zone.add(...zoneParts());
    this.group.add(this.point, this.end, this.spring, this.zone);
    for (const part of this.group.children) part.renderOrder = 8;
    this.hide();
  }

  hide(): void {
    this.group.visible = false;
  }

  /** The cursor is over the beam, and could hold it here. */
  offer(grab: Vector3): void {
    this.group.visible = true;
    this.end.visible = this.spring.visible = this.zone.visible = false;
    this.point.position.copy(grab);
    this.point.scale.setScalar(1.8);
  }

  /** A hand holds at `grab` and is at `target`; `half` of the zone's sides in world axes [m]. */
  show(grab: Vector3, target: Vector3, half: Vector3 | null): void {
    this.group.visible = this.end.visible = this.spring.visible = true;
    this.point.position.copy(grab);
    this.point.scale.setScalar(1);
    this.end.position.copy(target);
    this.zone.visible = half !== null;
    if (half) {
      this.zone.position.copy(grab);
      this.zone.scale.copy(half).multiplyScalar(2);
    }
    this.coil(grab, target);
  }

  private coil(from: Vector3, to: Vector3): void {
    const way = to.clone().sub(from);
    const side = new Vector3(0, 0, 1).cross(way);
    if (side.lengthSq() < 1e-9) side.set(1, 0, 0);
    side.setLength(Math.min(WIDTH, 0.3 * way.length()));
    const last = 2 * COILS + 1;
    for (let i = 0; i <= last; i++) {
      const bent = i < 2 || i > last - 2 ? 0 : i % 2 ? 1 : -1;
      const place = from
        .clone()
        .addScaledVector(way, i / last)
        .addScaledVector(side, bent);
      place.toArray(this.places, 3 * i);
    }
    this.spring.geometry.attributes["position"].needsUpdate = true;
  }
}

function zoneParts(): [Mesh, LineSegments] {
  const cube = new BoxGeometry(1, 1, 1);
  const glass = new MeshBasicMaterial({ color: palette.hand, transparent: true, opacity: 0.16, depthTest: false });
  const edge = new LineBasicMaterial({ color: palette.hand, transparent: true, opacity: 0.8, depthTest: false });
  return [new Mesh(cube, glass), new LineSegments(new EdgesGeometry(cube), edge)];
}
