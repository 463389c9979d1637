// A mark at a place of the world that is seen through everything: where a flight ended, where something touches.

import { Group, Mesh, MeshBasicMaterial, SphereGeometry, TorusGeometry, type Vector3 } from "three";

const POINT = 0.035; // m, radius
const RING = 0.16; // m, radius
const THICKNESS = 0.012; // m

export class Mark {
  readonly group = new Group();

  constructor(color: string) {
    const paint = new MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.95 });
    const rings = [0, Math.PI / 2].map((turn) => {
      const ring = new Mesh(new TorusGeometry(RING, THICKNESS, 8, 32), paint);
      ring.rotation.y = turn;
      return ring;
    });
    this.group.add(new Mesh(new SphereGeometry(POINT, 14, 10), paint), ...rings);
    for (const part of this.group.children) part.renderOrder = 9;
    this.group.visible = false;
  }

  hide(): void {
    this.group.visible = false;
  }

  show(place: Vector3): void {
    this.group.position.copy(place);
    this.group.visible = true;
  }
}
