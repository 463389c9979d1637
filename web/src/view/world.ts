// What stands still: the floor with its grid, and the corridor with its transparent walls.

import {
  BackSide,
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  Color,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  SphereGeometry,
  Vector3,
} from "three";

import type { FlightScene, SceneWall } from "../wire/messages.generated.ts";
import type { Graphics } from "./graphics.ts";
import { together } from "./shapes.ts";
import { palette } from "./palette.ts";

const EXTENT = 30; // m, half of the grid that moves with the vehicle
const NEAR = 15; // m, half of the fine lines of light graphics
const COARSE = 5; // m, between bold lines
const PIECE = 5; // m
const BOLD = 0.9; // opacity of lines, each fifth and the others
const FINE = 0.5;
const CLEAR = 0.1; // opacity of a wall between the eye and the vehicle
const CLOUDY = 0.34;
const CORNERS = 24; // of a box as three.js builds it

export class World {
  readonly group = new Group();
  private readonly ground = new Group();
  private readonly walls: Walls | null;

  constructor(scene: FlightScene, graphics: Graphics) {
    this.ground.position.z = scene.floor;
    // in light graphics the background is the floor: it costs nothing
    if (scene.ground && graphics === "full") this.ground.add(floor());
    this.ground.add(grid(graphics === "full" ? EXTENT : NEAR));
    this.group.add(this.ground);
    if (graphics === "full") this.group.add(sky());
    this.walls = scene.walls.length ? new Walls(scene.walls, graphics) : null;
    if (this.walls) this.group.add(...this.walls.parts);
    if (scene.corridor) this.group.add(lane(scene, graphics));
  }

  /** Keeps the floor below the vehicle, and the walls that hide it transparent. */
  update(vehicle: Vector3, eye: Vector3): void {
    this.ground.position.x = COARSE * Math.round(vehicle.x / COARSE);
    this.ground.position.y = COARSE * Math.round(vehicle.y / COARSE);
    this.walls?.update(vehicle, eye);
  }
}

/** All walls as one mesh, and all their edges as another: two draw calls. */
class Walls {
  readonly parts: [Mesh, LineSegments];
  private readonly paint: BufferAttribute;
  private readonly places: { center: Vector3; across: Vector3; clear: boolean }[];

  constructor(walls: SceneWall[], graphics: Graphics) {
    const boxes = walls.map((wall) => new BoxGeometry(...wall.size).rotateZ(wall.heading).translate(...wall.center));
    const edges = together(boxes.map((box) => new EdgesGeometry(box)));
    const shape = together(boxes);
    const { r, g, b } = new Color(palette.wall);
    const colors = Array.from({ length: CORNERS * walls.length }, () => [r, g, b, CLOUDY]).flat();
    this.paint = new BufferAttribute(new Float32Array(colors), 4);
    shape.setAttribute("color", this.paint);
    const look = { vertexColors: true, transparent: true, depthWrite: false };
    const glass = graphics === "light" ? new MeshBasicMaterial(look) : new MeshLambertMaterial(look);
    this.parts = [new Mesh(shape, glass), new LineSegments(edges, new LineBasicMaterial({ color: palette.frame }))];
    this.parts[0].renderOrder = 2;
    this.places = walls.map(({ center, size, heading }) => {
      const [x, y] = size[0] < size[1] ? [1, 0] : [0, 1];
      const across = new Vector3(x, y, 0).applyAxisAngle(new Vector3(0, 0, 1), heading);
      return { center: new Vector3(...center), across, clear: false };
    });
  }

  /** Makes the walls between the eye and the vehicle transparent. */
  update(vehicle: Vector3, eye: Vector3): void {
    this.places.forEach((wall, i) => {
      const side = (place: Vector3) => wall.across.dot(place) - wall.across.dot(wall.center);
      const clear = side(vehicle) * side(eye) < 0;
      if (clear === wall.clear) return;
      wall.clear = clear;
      for (let k = CORNERS * i; k < CORNERS * (i + 1); k++) this.paint.setW(k, clear ? CLEAR : CLOUDY);
      this.paint.needsUpdate = true;
    });
  }
}

function floor(): Mesh {
  const size = 6 * EXTENT;
  // nothing is below it, so it needs no depth
  const mesh = new Mesh(new PlaneGeometry(size, size), new MeshLambertMaterial({ color: palette.floor, depthWrite: false }));
  mesh.receiveShadow = true;
  mesh.renderOrder = -2;
  return mesh;
}

/**
 * Lines in short pieces: some software renderers drop a line that passes behind the eye. The fine ones fade until they
 * are `near` away, as many short lines are what such a renderer draws slowest.
 */
function grid(near: number): LineSegments {
  const ends: number[] = [];
  const colors: number[] = [];
  const { r, g, b } = new Color(palette.grid);
  for (let i = -EXTENT; i <= EXTENT; i++) {
    const bold = i % COARSE === 0;
    for (let j = -EXTENT; j < EXTENT; j += PIECE) {
      const [from, to] = [j, j + PIECE].map((along) => {
        const left = near === EXTENT ? 1 : 1 - Math.hypot(i, along) / near;
        return bold ? BOLD : FINE * Math.max(left, 0);
      });
      if (from + to === 0) continue;
      ends.push(j, i, 0, j + PIECE, i, 0, i, j, 0, i, j + PIECE, 0);
      for (const opacity of [from, to, from, to]) colors.push(r, g, b, opacity);
    }
  }
  const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  shape.setAttribute("color", new BufferAttribute(new Float32Array(colors), 4));
  return new LineSegments(shape, new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
}

/** The floor of the corridor, brighter than the rest. */
function lane(scene: FlightScene, graphics: Graphics): Mesh {
  const { centreline, width } = scene.corridor!;
  const corners: number[] = [];
  const faces: number[] = [];
  centreline.forEach(([x, y], i) => {
    const [dx, dy] = mitre(centreline, i, width / 2);
    corners.push(x - dx, y - dy, 0, x + dx, y + dy, 0);
    if (i) faces.push(...[0, 2, 1, 1, 2, 3].map((k) => 2 * (i - 1) + k));
  });
  const shape = new BufferGeometry();
  shape.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
  shape.setIndex(faces);
  shape.computeVertexNormals();
  const look = { color: palette.lane, depthWrite: false };
  const mesh = new Mesh(shape, graphics === "light" ? new MeshBasicMaterial(look) : new MeshLambertMaterial(look));
  mesh.receiveShadow = graphics === "full";
  mesh.position.z = scene.floor;
  mesh.renderOrder = -1;
  return mesh;
}

/** From a corner of a line to the left corner of a band of a half width around it. */
function mitre(line: [number, number][], i: number, half: number): [number, number] {
  const way = (a: number): number => {
    const [from, to] = [line[Math.max(a, 0)], line[Math.min(a + 1, line.length - 1)]];
    return Math.atan2(to[1] - from[1], to[0] - from[0]);
  };
  const [before, after] = [way(i > 0 ? i - 1 : 0), way(Math.min(i, line.length - 2))];
  const turn = Math.atan2(Math.sin(after - before), Math.cos(after - before)) / 2;
  const reach = half / Math.max(Math.cos(turn), 0.3);
  return [-Math.sin(before + turn) * reach, Math.cos(before + turn) * reach];
}

/** A dome that is bright at the horizon and blue above. */
function sky(): Mesh {
  const shape = new SphereGeometry(300, 24, 16).rotateX(Math.PI / 2);
  const places = shape.getAttribute("position");
  const [low, high] = [new Color(palette.haze), new Color(palette.zenith)];
  const colors = Array.from({ length: places.count }, (_, i) => {
    const height = Math.min(Math.max(places.getZ(i) / 300, 0), 1);
    return low.clone().lerp(high, Math.sqrt(height)).toArray();
  }).flat();
  shape.setAttribute("color", new BufferAttribute(new Float32Array(colors), 3));
  const paint = new MeshBasicMaterial({ vertexColors: true, side: BackSide, fog: false, depthWrite: false });
  const mesh = new Mesh(shape, paint);
  mesh.renderOrder = -3; // before the floor, which writes no depth
  return mesh;
}
