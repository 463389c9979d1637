// The camera: orbits the vehicle, follows it, and has a few preset views.

import { Matrix4, type Object3D, type PerspectiveCamera, Quaternion, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import type { STEP_WORDS, Vector } from "../wire/messages.generated.ts";

export type View = (typeof STEP_WORDS.camera)[number];

const PLACES: Record<Exclude<View, "board">, [number, number, number]> = {
  // from the vehicle to the eye, in units of the vehicle's reach; the corridor leads along x
  behind: [-2.25, -1.1, 1.15],
  side: [0.2, -3.1, 0.75],
  above: [-0.02, 0, 4],
};
const FAR = 2.4; // times as high, above a corridor
const SLACK = 0.16; // of the distance: while a hand pulls, the camera stands still up to this offset
const BANDWIDTH = 6; // 1/s, of following
const ANGLE = 42; // deg, of the picture's height; on board wider
const ANGLE_ON_BOARD = 66;
const EYE = new Vector3(-0.62, 0, 0.36); // m from a quadrotor, body axes: behind it and above
const AHEAD = 3; // m before the vehicle's middle, where one looks to on board

export class ChaseCamera {
  readonly orbit: OrbitControls;
  following = true;
  private readonly vehicle = new Vector3();
  private fitted = 1; // the fit that the distance stands for
  private seat: { eye: Vector3; turn: Quaternion } | null = null; // on board, body axes

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

  /** Places the camera for a vehicle of a reach [m]; `far`: above, to see where a corridor leads. */
  look(view: Exclude<View, "board">, vehicle: Vector3, reach: number, far = false): void {
    this.leave();
    this.vehicle.copy(vehicle);
    this.fitted = this.fit;
    this.orbit.target.copy(vehicle);
    const distance = reach * this.fitted * (far && view === "above" ? FAR : 1);
    this.camera.position.copy(vehicle).addScaledVector(new Vector3(...PLACES[view]), distance);
    this.orbit.update();
  }

  /** Takes a seat on a quadrotor at a place of the body. */
  board(place: Vector): void {
    this.leave(ANGLE_ON_BOARD);
    const eye = new Vector3(...place).add(EYE);
    const view = new Matrix4().lookAt(eye, new Vector3(AHEAD, 0.3 * place[1], place[2] - 0.3), this.camera.up);
    this.seat = { eye, turn: new Quaternion().setFromRotationMatrix(view) };
    this.orbit.enabled = false;
  }

  private leave(angle = ANGLE): void {
    this.seat = null;
    this.orbit.enabled = true;
    this.camera.fov = angle;
    this.camera.updateProjectionMatrix();
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
  update(body: Object3D, pulling: boolean, passed: number): void {
    const vehicle = body.position;
    if (this.seat) {
      this.camera.position.copy(body.localToWorld(this.seat.eye.clone()));
      this.camera.quaternion.copy(body.quaternion).multiply(this.seat.turn);
      return;
    }
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
