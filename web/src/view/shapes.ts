// Solid shapes with a colour at each vertex, so that a whole vehicle is one mesh.

import {
  BoxGeometry,
  BufferGeometry,
  Color,
  CylinderGeometry,
  Float32BufferAttribute,
  Matrix4,
  SphereGeometry,
  Vector3,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

import type { SceneShape } from "../wire/messages.generated.ts";
import { inTheme } from "./palette.ts";

/** From a shape's own axes to body axes. */
export function placeOf({ axes, position }: SceneShape): Matrix4 {
  const [x, y, z] = [0, 3, 6].map((at) => new Vector3(...axes.slice(at, at + 3)));
  return new Matrix4().makeBasis(x, y, z).setPosition(...position);
}

/** Shapes as one, with so many sides of a full turn. */
export function solid(shapes: readonly SceneShape[], sides: number): BufferGeometry {
  return together(shapes.map((shape) => painted(geometry(shape, sides).applyMatrix4(placeOf(shape)), shape.color)));
}

export function together(parts: BufferGeometry[]): BufferGeometry {
  const whole = mergeGeometries(parts);
  for (const part of parts) part.dispose();
  return whole;
}

const THIN = 0.025; // m, radius below which half the sides look as round

function geometry({ kind, size }: SceneShape, most: number): BufferGeometry {
  const sides = kind !== "box" && size[0] < THIN ? Math.max(Math.ceil(most / 2), 4) : most;
  if (kind === "box") return new BoxGeometry(...size);
  if (kind === "hull") return facets(size);
  if (kind === "sphere") return new SphereGeometry(size[0], sides, Math.ceil(sides / 2));
  return new CylinderGeometry(size[0], size[0], size[1], sides).rotateX(Math.PI / 2); // three.js builds it along y
}

/** A surface of flat triangles, nine numbers each. */
function facets(corners: readonly number[]): BufferGeometry {
  const count = corners.length / 3;
  const shape = new BufferGeometry().setAttribute("position", new Float32BufferAttribute([...corners], 3));
  shape.setAttribute("uv", new Float32BufferAttribute(new Float32Array(2 * count), 2)); // merging needs equal attributes
  shape.setIndex([...Array(count).keys()]).computeVertexNormals();
  return shape;
}

function painted(shape: BufferGeometry, color: string): BufferGeometry {
  const { r, g, b } = new Color(inTheme(color));
  const colors = Array.from({ length: shape.getAttribute("position").count }, () => [r, g, b]).flat();
  return shape.setAttribute("color", new Float32BufferAttribute(colors, 3));
}
