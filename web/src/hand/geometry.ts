// Where a hand is in space: rays through the cursor, the beam's axis, the plane in which a drag moves.

import type { Quaternion, Vector } from "../wire/protocol.ts";

export interface Ray {
  origin: Vector;
  direction: Vector; // of length 1
}

export const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const less = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const size = (a: Vector): number => Math.hypot(a[0], a[1], a[2]);
export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** A vector of the body in world axes. */
export function turned(q: Quaternion, v: Vector): Vector {
  const axis: Vector = [q[1], q[2], q[3]];
  const twice = times(cross(axis, v), 2);
  return add(add(v, times(twice, q[0])), cross(axis, twice));
}

/** A vector of the world in body axes. */
export function unturned(q: Quaternion, v: Vector): Vector {
  return turned([q[0], -q[1], -q[2], -q[3]], v);
}

export interface Nearest {
  point: Vector; // of the segment
  gap: number; // between it and the ray [m]
  depth: number; // along the ray [m]
}

/** The point of the segment from `a` to `b` that is nearest to a ray; behind the eye counts as at the eye. */
export function nearestToRay(ray: Ray, a: Vector, b: Vector): Nearest {
  const along = less(b, a);
  const from = less(ray.origin, a);
  const [dd, de, ee] = [dot(along, along), dot(along, ray.direction), dot(along, from)];
  const spread = dd - de * de; // |direction| = 1
  const share = spread > 1e-9 * dd ? (ee - de * dot(ray.direction, from)) / spread : 0.5;
  const point = add(a, times(along, Math.min(Math.max(share, 0), 1)));
  const depth = Math.max(dot(less(point, ray.origin), ray.direction), 0);
  return { point, gap: size(less(add(ray.origin, times(ray.direction, depth)), point)), depth };
}

/** Where a ray from the eye meets the plane across `ahead` at a depth [m]; null if it looks past the plane. */
export function onPlane(ray: Ray, ahead: Vector, depth: number): Vector | null {
  const closing = dot(ray.direction, ahead);
  return closing > 0.05 ? add(ray.origin, times(ray.direction, depth / closing)) : null;
}

/** Where a ray from the eye meets the level plane at a height [m]; null if it does not within `far` [m]. */
export function onLevel(ray: Ray, height: number, far: number): Vector | null {
  const way = (height - ray.origin[2]) / ray.direction[2];
  return way > 0 && way < far ? add(ray.origin, times(ray.direction, way)) : null;
}

/** The depth after a turn of the wheel: a notch of 100 is 6 % of the way, never through the eye. */
export function deeper(depth: number, notches: number): number {
  return Math.min(Math.max(depth * Math.exp(-0.0006 * notches), 0.3), 200);
}

/** The ways of a level push as seen from a camera that looks `ahead`: [forward, left], level and of length 1. */
export function levelWays(ahead: Vector, up: Vector): [Vector, Vector] {
  const flat: Vector = Math.hypot(ahead[0], ahead[1]) > 1e-3 ? [ahead[0], ahead[1], 0] : [up[0], up[1], 0];
  const forward = times(flat, 1 / Math.max(size(flat), 1e-9));
  return [forward, [-forward[1], forward[0], 0]];
}
