// The vehicle: its solid parts as one mesh, its rotors as instances, its ghost at the reference.

import {
  type BufferGeometry,
  Group,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
} from "three";

import type { FlightScene, Quaternion, ScenePayload, Vector } from "../wire/messages.generated.ts";
import type { Graphics } from "./graphics.ts";
import { palette } from "./palette.ts";
import { Rotors } from "./rotors.ts";
import { solid } from "./shapes.ts";

export interface Axis {
  from: Vector;
  to: Vector;
  radius: number;
}

/** The line in body axes along which the payload can be held. */
export function beamAxis(payload: ScenePayload): Axis {
  const [x, y, z] = payload.position;
  const half = payload.length / 2;
  return { from: [x, y - half, z], to: [x, y + half, z], radius: Math.max(payload.width, payload.height) / 2 };
}

export class Vehicle {
  readonly group = new Group();
  readonly outline: BufferGeometry; // the solid in less detail, for its shadow and its ghost
  readonly rotors: Rotors;

  constructor(scene: FlightScene, graphics: Graphics) {
    const { shapes } = scene.vehicle;
    const whole = solid(shapes, graphics === "full" ? 24 : 9);
    this.outline = graphics === "full" ? whole : solid(shapes, 5);
    const body = new Mesh(whole, surface(graphics));
    body.castShadow = body.receiveShadow = graphics === "full";
    body.frustumCulled = false;
    this.rotors = new Rotors(scene, graphics);
    this.group.add(body, this.rotors.group);
  }

  place(position: Vector, attitude: Quaternion): void {
    this.group.position.set(...position);
    this.group.quaternion.set(attitude[1], attitude[2], attitude[3], attitude[0]);
  }
}

export interface Pose {
  position: Vector;
  attitude: Quaternion;
}

/** The reference pose, or that of the best run: transparent, and visible only where it is off the vehicle. */
export class Ghost {
  readonly group = new Group();
  private readonly veil: MeshBasicMaterial;

  constructor(outline: BufferGeometry, tint = palette.path) {
    this.veil = new MeshBasicMaterial({ color: tint, transparent: true, opacity: 0.35, depthWrite: false });
    const depth = new Mesh(outline, new MeshBasicMaterial({ colorWrite: false, transparent: true }));
    const color = new Mesh(outline, this.veil);
    depth.renderOrder = 5;
    color.renderOrder = 6;
    this.group.add(depth, color);
  }

  /** Shows a pose, if there is one. */
  show(pose: Pose | null): void {
    this.group.visible = pose !== null;
    if (!pose) return;
    const [w, x, y, z] = pose.attitude;
    this.group.position.set(...pose.position);
    this.group.quaternion.set(x, y, z, w).normalize();
  }

  place(position: Vector, yaw: number, gap: number): void {
    const opacity = 0.3 * Math.min(Math.max((gap - 0.02) / 0.1, 0), 1);
    this.group.visible = opacity > 0.01;
    this.veil.opacity = opacity;
    this.group.position.set(...position);
    this.group.rotation.set(0, 0, yaw);
  }
}

function surface(graphics: Graphics): Material {
  if (graphics === "light") return new MeshLambertMaterial({ vertexColors: true });
  return new MeshStandardMaterial({ vertexColors: true, roughness: 0.5, metalness: 0.15 });
}
