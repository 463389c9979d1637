// A person of 1.75 m, for scale, who keeps beside the vehicle.

import {
  type BufferGeometry,
  CylinderGeometry,
  LatheGeometry,
  Mesh,
  MeshLambertMaterial,
  SphereGeometry,
  Vector2,
  Vector3,
} from "three";

import type { Graphics } from "./graphics.ts";
import { palette } from "./palette.ts";
import { together } from "./shapes.ts";

const TALL = 1.75; // m
const [NEAR, FAR] = [1, 1.4]; // m from the vehicle's middle
const TORSO = [0.001, 0, 0.15, 0, 0.165, 0.1, 0.135, 0.28, 0.17, 0.5, 0.19, 0.57, 0.12, 0.64, 0.05, 0.66, 0.05, 0.72]; // m

export class Person {
  readonly mesh: Mesh;
  private placed = false;

  constructor(
    private readonly floor: number,
    private readonly reach: number,
    graphics: Graphics,
  ) {
    this.mesh = new Mesh(figure(graphics === "full" ? 20 : 8), new MeshLambertMaterial({ color: palette.person }));
    this.mesh.castShadow = graphics === "full";
    this.mesh.visible = false;
  }

  /** Walks as far as it takes to stay beside a vehicle, and looks at it. */
  accompany(vehicle: Vector3): void {
    const { position } = this.mesh;
    if (!this.placed) position.set(vehicle.x + NEAR, vehicle.y + 0.3 * this.reach, this.floor);
    this.placed = true;
    const way = new Vector3(vehicle.x - position.x, vehicle.y - position.y, 0);
    const apart = way.length();
    const wanted = Math.min(Math.max(apart, NEAR), FAR);
    if (apart > 0) position.addScaledVector(way, 1 - wanted / apart);
    this.mesh.rotation.z = Math.atan2(way.y, way.x);
  }
}

/** Stands on the origin and looks along x. */
function figure(sides: number): BufferGeometry {
  const profile = TORSO.flatMap((radius, i) => (i % 2 ? [] : [new Vector2(radius, TORSO[i + 1])]));
  const upright = (top: number, bottom: number, length: number): CylinderGeometry =>
    new CylinderGeometry(top, bottom, length, sides);
  const limbs = [-1, 1].flatMap((side) => [
    upright(0.085, 0.05, 0.86).translate(0, 0.43, 0.095 * side),
    upright(0.05, 0.038, 0.66).rotateX(-0.12 * side).translate(0, 1.1, 0.235 * side),
    new SphereGeometry(0.06, sides, sides).scale(2.1, 0.7, 0.85).translate(0.06, 0.04, 0.095 * side),
  ]);
  const torso = new LatheGeometry(profile, sides).scale(0.68, 1, 1).translate(0, 0.83, 0);
  const head = new SphereGeometry(0.1, sides, sides).scale(0.95, 1.2, 0.82).translate(0.015, TALL - 0.12, 0);
  // built upright along y, as three.js has it
  return together([torso, head, ...limbs]).rotateX(Math.PI / 2);
}
