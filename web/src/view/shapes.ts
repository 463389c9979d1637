// Solid shapes with a colour at each vertex, so that a whole vehicle is one mesh.

import {
  BoxGeometry,
  type BufferGeometry,
  Color,
  CylinderGeometry,
  Float32BufferAttribute,
  LatheGeometry,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector2,
  Vector3,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

export type Place = Vector3;
export const at = (x: number, y: number, z: number): Place => new Vector3(x, y, z);

const UP = new Vector3(0, 1, 0); // along which three.js builds its cylinders

/** Sides of a full turn. */
export interface Detail {
  sides: number;
}

export function painted(shape: BufferGeometry, color: string): BufferGeometry {
  const { r, g, b } = new Color(color);
  const count = shape.getAttribute("position").count;
  const colors = Array.from({ length: count }, () => [r, g, b]).flat();
  return shape.setAttribute("color", new Float32BufferAttribute(colors, 3));
}

/** A rod, or a cone if its radii differ. */
export function rod(
  from: Place,
  to: Place,
  radius: number,
  color: string,
  sides: number,
  end = radius,
): BufferGeometry {
  return between(from, to, new CylinderGeometry(end, radius, to.distanceTo(from), sides), color);
}

/** A rod without end faces. */
export function strut(from: Place, to: Place, radius: number, color: string, sides: number): BufferGeometry {
  return between(from, to, new CylinderGeometry(radius, radius, to.distanceTo(from), sides, 1, true), color);
}

function between(from: Place, to: Place, shape: BufferGeometry, color: string): BufferGeometry {
  const way = to.clone().sub(from);
  shape.applyQuaternion(new Quaternion().setFromUnitVectors(UP, way.clone().normalize()));
  const middle = from.clone().addScaledVector(way, 0.5);
  return painted(shape.translate(middle.x, middle.y, middle.z), color);
}

export function ball(center: Place, radius: number, color: string, sides: number): BufferGeometry {
  const shape = new SphereGeometry(radius, sides, Math.ceil(sides / 2));
  return painted(shape.translate(center.x, center.y, center.z), color);
}

export function box(center: Place, size: readonly [number, number, number], color: string): BufferGeometry {
  return painted(new BoxGeometry(...size).translate(center.x, center.y, center.z), color);
}

/** A level ring. */
export function ring(center: Place, radius: number, tube: number, color: string, sides: number): BufferGeometry {
  const shape = new TorusGeometry(radius, tube, Math.max(4, Math.ceil(sides / 3)), 3 * sides);
  return painted(shape.translate(center.x, center.y, center.z), color);
}

/** A profile of (radius, height) turned about z. */
export function lathe(profile: [number, number][], color: string, sides: number): BufferGeometry {
  const shape = new LatheGeometry(
    profile.map(([r, z]) => new Vector2(r, z)),
    2 * sides,
  );
  return painted(shape.rotateX(Math.PI / 2), color);
}

export function together(parts: BufferGeometry[]): BufferGeometry {
  const whole = mergeGeometries(parts);
  for (const part of parts) part.dispose();
  return whole;
}
