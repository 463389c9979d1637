// The vehicle: its solid parts as one mesh, its rotors as instances, its ghost at the reference.

import {
  type BufferGeometry,
  DoubleSide,
  Group,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
} from "three";

import type { FlightScene, Quaternion, ScenePayload, SceneQuadrotor, Vector } from "../wire/messages.generated.ts";
import type { Graphics } from "./graphics.ts";
import { JOINT, METAL, WOOD, palette } from "./palette.ts";
import { quadrotorParts } from "./quadrotor.ts";
import { Rotors } from "./rotors.ts";
import { at, rod, strut, together } from "./shapes.ts";

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
    const solid = solidOf(scene, graphics === "full" ? 20 : 7);
    this.outline = graphics === "full" ? solid : solidOf(scene, 5);
    const body = new Mesh(solid, surface(graphics));
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

/** The reference pose: transparent, and visible only where it is off the vehicle. */
export class Ghost {
  readonly group = new Group();
  private readonly veil = new MeshBasicMaterial({ color: palette.path, transparent: true, depthWrite: false });

  constructor(solid: BufferGeometry) {
    const depth = new Mesh(solid, new MeshBasicMaterial({ colorWrite: false, transparent: true }));
    const color = new Mesh(solid, this.veil);
    depth.renderOrder = 5;
    color.renderOrder = 6;
    this.group.add(depth, color);
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
  return new MeshStandardMaterial({ vertexColors: true, roughness: 0.5, metalness: 0.15, side: DoubleSide });
}

function solidOf(scene: FlightScene, sides: number): BufferGeometry {
  const { quadrotors, payload } = scene.vehicle;
  const parts = quadrotors.flatMap((quadrotor) => quadrotorParts(quadrotor, sides));
  return together([...beamParts(payload, sides), ...quadrotors.flatMap((q) => mount(payload, q, sides)), ...parts]);
}

function beamParts(payload: ScenePayload, sides: number): BufferGeometry[] {
  const { from, to, radius } = beamAxis(payload);
  const ends = [from, to].map((end) => {
    const cap = 0.012;
    return rod(at(end[0], end[1] - cap, end[2]), at(end[0], end[1] + cap, end[2]), 1.12 * radius, palette.carbon, 2 * sides);
  });
  return [rod(at(...from), at(...to), radius, WOOD, 2 * sides), ...ends];
}

/** The strut from the beam to a quadrotor, with the sensor's collar. */
function mount(payload: ScenePayload, quadrotor: SceneQuadrotor, sides: number): BufferGeometry[] {
  const axis = beamAxis(payload);
  const center = at(...quadrotor.position);
  const along = quadrotor.joint[1];
  const joint = at(axis.from[0], Math.min(Math.max(along, axis.from[1]), axis.to[1]), axis.from[2]);
  const way = center.clone().sub(joint);
  if (way.length() < 1e-3) return [];
  const width = 0.09 * quadrotor.arm;
  const start = joint.clone().addScaledVector(way, Math.min(axis.radius / way.length(), 0.6));
  const end = joint.clone().addScaledVector(way, Math.min((axis.radius + 2 * width) / way.length(), 0.9));
  return [strut(joint, center, width, METAL, sides), rod(start, end, 1.8 * width, JOINT, sides)];
}
