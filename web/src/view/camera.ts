// The camera: orbits the vehicle, follows it, and has a few preset views.

import { type PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export type View = "behind" | "side" | "above";

const PLACES: Record<View, [number, number, number]> = {
  // from the vehicle to the eye, in units of the vehicle's reach; the corridor leads along x
  behind: [-2.25, -1.1, 1.15],
  side: [0.2, -3.1, 0.75],
  above: [-0.02, 0, 4],
};
const SLACK = 0.16; // of the distance: while a hand pulls, the camera stands still up to this offset
const BANDWIDTH = 6; // 1/s, of following

export class ChaseCamera {
  readonly orbit: OrbitControls;
  following = true;
  private readonly vehicle = new Vector3();
  private fitted = 1; // the fit that the distance stands for

  constructor(
    readonly camera: PerspectiveCamera,
    surface: HTMLElement,
  ) {
    this.orbit = new OrbitControls(camera, surface);
    this.orbit.minDistance = 0.8;
    this.orbit.maxDistance = 80;
    this.orbit.maxPolarAngle = 0.53 * Math.PI;
    this.orbit.zoomSpeed = 0.8;
  }

  /** Places the camera for a vehicle of a reach [m]. */
  look(view: View, vehicle: Vector3, reach: number): void {
    this.vehicle.copy(vehicle);
    this.fitted = this.fit;
    this.orbit.target.copy(vehicle);
    this.camera.position.copy(vehicle).addScaledVector(new Vector3(...PLACES[view]), reach * this.fitted);
    this.orbit.update();
  }

  /** How much farther away a picture of this shape must be seen from: a narrow one is to hold the whole beam. */
  private get fit(): number {
    return Math.max(1, 1.35 / Math.max(this.camera.aspect, 0.4));
  }

  /** Keeps the vehicle as large a part of a picture whose shape has changed. */
  private refit(): void {
    const { target } = this.orbit;
    this.camera.position.sub(target).multiplyScalar(this.fit / this.fitted).add(target);
    this.fitted = this.fit;
  }

  /** Follows the vehicle; with slack while a hand pulls, so that a still cursor is a still target. */
  update(vehicle: Vector3, pulling: boolean, passed: number): void {
    if (this.fit !== this.fitted) this.refit();
    const jump = vehicle.distanceTo(this.vehicle) > 2;
    const step = vehicle.clone().sub(this.vehicle);
    this.vehicle.copy(vehicle);
    if (this.following && jump) this.move(step);
    else if (this.following) this.move(this.pursuit(vehicle, pulling, passed));
    this.orbit.update();
  }

  private pursuit(vehicle: Vector3, pulling: boolean, passed: number): Vector3 {
    const off = vehicle.clone().sub(this.orbit.target);
    const slack = pulling ? SLACK * this.camera.position.distanceTo(this.orbit.target) : 0;
    const excess = Math.max(off.length() - slack, 0);
    return off.setLength(excess * (1 - Math.exp(-BANDWIDTH * passed)));
  }

  private move(step: Vector3): void {
    this.orbit.target.add(step);
    this.camera.position.add(step);
  }
}
