// An arrow from where something acts, of a length that shows its strength.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Quaternion, Vector3 } from "three";

import type { Vector } from "../wire/messages.generated.ts";

const ALONG = new Vector3(0, 1, 0); // along which three.js builds cylinders

export class Arrow {
  readonly group = new Group();
  readonly tip = new Vector3();
  private readonly shaft: Mesh;
  private readonly head: Mesh;

  constructor(
    color: string,
    private readonly radius: number,
    private readonly scale: number, // m per unit of strength
    private readonly faintest: number,
  ) {
    const paint = new MeshLambertMaterial({ color, emissive: color, emissiveIntensity: 0.35 });
    this.shaft = new Mesh(new CylinderGeometry(radius, radius, 1, 12), paint);
    this.head = new Mesh(new ConeGeometry(2.6 * radius, 7 * radius, 14), paint);
    this.group.add(this.shaft, this.head);
    this.group.visible = false;
  }

  get visible(): boolean {
    return this.group.visible;
  }

  /** Shows a vector that acts at a place of the world, where the arrow starts. */
  show(from: Vector3, vector: Vector): void {
    const way = new Vector3(...vector);
    const strength = way.length();
    this.group.visible = strength > this.faintest;
    if (!this.group.visible) return;
    // a short arrow is scaled down as a whole
    const length = strength * this.scale;
    const fraction = Math.min(length / (8 * this.radius), 1);
    const neck = length / fraction - 7 * this.radius;
    this.group.scale.setScalar(fraction);
    this.group.position.copy(from);
    this.group.quaternion.copy(new Quaternion().setFromUnitVectors(ALONG, way.divideScalar(strength)));
    this.shaft.scale.y = neck;
    this.shaft.position.y = neck / 2;
    this.head.position.y = neck + 3.5 * this.radius;
    this.tip.copy(from).addScaledVector(way, length);
  }
}
