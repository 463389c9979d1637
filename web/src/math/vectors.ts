// Vectors, rotations and rays: of the cursor, the beam's axis, and the plane in which a drag moves.

import type { Quaternion, Vector } from "../wire/messages.generated.ts";

export interface Ray {
  origin: Vector;
  direction: Vector; // of length 1
}

export const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const size = (a: Vector): number => Math.hypot(a[0], a[1], a[2]);
export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** A vector of the body in world axes. */
export function toWorld(q: Quaternion, v: Vector): Vector {
  const axis: Vector = [q[1], q[2], q[3]];
  const twice = scale(cross(axis, v), 2);
  return add(add(v, scale(twice, q[0])), cross(axis, twice));
}

/** A vector of the world in body axes. */
export function toBody(q: Quaternion, v: Vector): Vector {
  return toWorld([q[0], -q[1], -q[2], -q[3]], v);
}

export interface Nearest {
  point: Vector; // of the segment
  gap: number; // between it and the ray [m]
  depth: number; // along the ray [m]
}

/** The point of the segment from `a` to `b` that is nearest to a ray; behind the eye counts as at the eye. */
export function nearestToRay(ray: Ray, a: Vector, b: Vector): Nearest {
  const along = subtract(b, a);
  const from = subtract(ray.origin, a);
  const [dd, de, ee] = [dot(along, along), dot(along, ray.direction), dot(along, from)];
  const spread = dd - de * de; // |direction| = 1
  const fraction = spread > 1e-9 * dd ? (ee - de * dot(ray.direction, from)) / spread : 0.5;
  const point = add(a, scale(along, Math.min(Math.max(fraction, 0), 1)));
  const depth = Math.max(dot(subtract(point, ray.origin), ray.direction), 0);
  return { point, gap: size(subtract(add(ray.origin, scale(ray.direction, depth)), point)), depth };
}

/** Where a ray from the eye meets the plane across `ahead` at a depth [m]; null if it misses the plane. */
export function meetPlane(ray: Ray, ahead: Vector, depth: number): Vector | null {
  const closing = dot(ray.direction, ahead);
  return closing > 0.05 ? add(ray.origin, scale(ray.direction, depth / closing)) : null;
}

/** Where a ray from the eye meets the level plane at a height [m]; null if it does not within `far` [m]. */
export function meetLevelPlane(ray: Ray, height: number, far: number): Vector | null {
  const distance = (height - ray.origin[2]) / ray.direction[2];
  return distance > 0 && distance < far ? add(ray.origin, scale(ray.direction, distance)) : null;
}

/** The depth after a turn of the wheel: a notch of 100 is 6 % of the depth, and never passes the eye. */
export function depthAfterWheel(depth: number, notches: number): number {
  return Math.min(Math.max(depth * Math.exp(-0.0006 * notches), 0.3), 200);
}

/** The directions of a level push as seen from a camera that looks `ahead`: [forward, left], level and of length 1. */
export function levelDirections(ahead: Vector, up: Vector): [Vector, Vector] {
  const flat: Vector = Math.hypot(ahead[0], ahead[1]) > 1e-3 ? [ahead[0], ahead[1], 0] : [up[0], up[1], 0];
  const forward = scale(flat, 1 / Math.max(size(flat), 1e-9));
  return [forward, [-forward[1], forward[0], 0]];
}
