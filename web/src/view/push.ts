// The push where it acts: its force as an arrow, its moment as a curved one, and the hoop of the admittance's threshold.

import { ConeGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, TorusGeometry, Vector3 } from "three";

import { size } from "../math/vectors.ts";
import type { Vector } from "../wire/messages.generated.ts";
import { Arrow } from "./arrow.ts";
import { palette } from "./palette.ts";

const LENGTH = 0.22; // m per newton
const FAINTEST = 0.05; // N or N m: less is not drawn
const AXIS = new Vector3(0, 0, 1); // of rings as three.js builds them
const [RADIUS, THICK] = [0.17, 0.012]; // m, of the curved arrow
const [TURN, LEAST, MOST] = [1.2, 0.5, 1.75 * Math.PI]; // rad per newton metre, and rad at least and at most
const [PIECES, SIDES] = [56, 6];

/** The largest push in a direction that stays below the threshold of every axis [N]. */
export function thresholdAlong(push: Vector, threshold: Vector): number {
  const shares = push.map((part, i) => (part === 0 ? Infinity : threshold[i] / Math.abs(part)));
  return size(push) * Math.min(...shares);
}

/** A push in words; below the threshold, its part along the axis that is nearest to its threshold, and that threshold. */
export function pushText(push: Vector, threshold: Vector): string {
  const digits = (value: number): string => value.toFixed(value < 1 ? 2 : 1);
  const shares = push.map((part, i) => Math.abs(part) / threshold[i]);
  const most = Math.max(...shares);
  if (most > 1) return `${digits(size(push))} N`;
  const axis = shares.indexOf(most);
  return `${digits(Math.abs(push[axis]))} of ${digits(threshold[axis])} N along ${"xyz"[axis]}`;
}

/** A part of a ring whose triangles follow one another along it, so that the first of them are a shorter part. */
function growingRing(): TorusGeometry {
  const shape = new TorusGeometry(RADIUS, THICK, SIDES, PIECES, MOST);
  const around = [...shape.index!.array]; // side by side, each along the whole ring
  const pieces = Array.from({ length: SIDES * PIECES }, (_, i) => (i % SIDES) * PIECES + Math.floor(i / SIDES));
  shape.setIndex(pieces.flatMap((piece) => around.slice(6 * piece, 6 * piece + 6)));
  return shape;
}

/** A curved arrow around the axis of a moment, the longer the stronger. */
class MomentArrow {
  readonly group = new Group();
  readonly tip = new Vector3();
  private readonly tube: Mesh;
  private readonly head: Mesh;

  constructor(color: string) {
    const paint = new MeshLambertMaterial({ color, emissive: color, emissiveIntensity: 0.35 });
    this.tube = new Mesh(growingRing(), paint);
    this.head = new Mesh(new ConeGeometry(2.8 * THICK, 8 * THICK, 12), paint);
    this.group.add(this.tube, this.head);
  }

  show(from: Vector3, moment: Vector3): void {
    const strength = moment.length();
    this.group.visible = strength > FAINTEST;
    if (!this.group.visible) return;
    const angle = Math.min(Math.max(TURN * strength, LEAST), MOST);
    this.tube.geometry.setDrawRange(0, 6 * SIDES * Math.round((PIECES * angle) / MOST));
    this.head.position.set(RADIUS * Math.cos(angle), RADIUS * Math.sin(angle), 0);
    this.head.rotation.z = angle;
    this.group.position.copy(from);
    this.group.quaternion.setFromUnitVectors(AXIS, moment.clone().divideScalar(strength));
    this.group.updateMatrixWorld();
    this.tip.copy(this.head.position).applyMatrix4(this.group.matrixWorld);
  }
}

export class PushMark {
  readonly group = new Group();
  readonly arrow = new Arrow(palette.push, 0.02, LENGTH, FAINTEST);
  readonly moment = new MomentArrow(palette.moment);
  private readonly hoop: Mesh<TorusGeometry, MeshBasicMaterial>;

  constructor() {
    const paint = new MeshBasicMaterial({ color: palette.hand, transparent: true });
    this.hoop = new Mesh(new TorusGeometry(0.075, 0.008, 4, 20), paint);
    this.group.add(this.arrow.group, this.moment.group, this.hoop);
  }

  /** Shows a push [N] and its moment [N m] in world axes; `threshold` [N]: of the hoop, or null for none. */
  show(from: Vector3, push: Vector, moment: Vector3, threshold: Vector | null): void {
    this.arrow.show(from, push);
    this.moment.show(from, moment);
    const limit = threshold ? thresholdAlong(push, threshold) : 0;
    this.hoop.visible = this.arrow.visible && limit > 0 && limit < Infinity;
    if (!this.hoop.visible) return;
    const way = new Vector3(...push).normalize();
    this.hoop.position.copy(from).addScaledVector(way, LENGTH * limit);
    this.hoop.quaternion.setFromUnitVectors(AXIS, way);
    this.hoop.material.opacity = size(push) > limit ? 0.5 : 1;
  }
}
