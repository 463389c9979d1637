// What stands still: the floor with its grid, the corridor and its walls, through which one can see.

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

import type { Scene, Wall } from "../wire/protocol.ts";
import type { Graphics } from "./graphics.ts";
import { FLOOR, FRAME, GRID, HAZE, LANE, WALL, ZENITH } from "./palette.ts";

const EXTENT = 30; // m, half of the grid that moves with the vehicle
const COARSE = 5; // m, between bold lines
const PIECE = 5; // m
const SEEN_THROUGH = 0.1; // opacity of a wall between the eye and the vehicle
const CLOUDY = 0.34;

export class World {
  readonly group = new Group();
  private readonly ground = new Group();
  private readonly walls: { mesh: Mesh<BoxGeometry, MeshBasicMaterial | MeshLambertMaterial>; across: Vector3 }[] = [];

  constructor(scene: Scene, graphics: Graphics) {
    this.ground.position.z = scene.floor ?? 0;
    // in light graphics the background is the floor: it costs nothing
    if (scene.ground && graphics === "full") this.ground.add(floor());
    this.ground.add(grid(1, 0.5), grid(COARSE, 0.9));
    this.group.add(this.ground);
    if (graphics === "full") this.group.add(sky());
    for (const wall of scene.walls) this.addWall(wall, graphics);
    if (scene.corridor?.centreline.length) this.group.add(lane(scene, graphics));
  }

  /** Keeps the floor below the vehicle, and the walls that hide it thin. */
  update(vehicle: Vector3, eye: Vector3): void {
    this.ground.position.x = COARSE * Math.round(vehicle.x / COARSE);
    this.ground.position.y = COARSE * Math.round(vehicle.y / COARSE);
    for (const { mesh, across } of this.walls) {
      const side = (place: Vector3) => across.dot(place.clone().sub(mesh.position));
      mesh.material.opacity = side(vehicle) * side(eye) < 0 ? SEEN_THROUGH : CLOUDY;
    }
  }

  private addWall(wall: Wall, graphics: Graphics): void {
    const shape = new BoxGeometry(...wall.size);
    const look = { color: WALL, transparent: true, opacity: CLOUDY, depthWrite: false };
    const glass = graphics === "light" ? new MeshBasicMaterial(look) : new MeshLambertMaterial(look);
    const mesh = new Mesh(shape, glass);
    const edges = new LineSegments(new EdgesGeometry(shape), new LineBasicMaterial({ color: FRAME }));
    mesh.position.set(...wall.center);
    mesh.rotation.z = wall.heading;
    mesh.add(edges);
    mesh.renderOrder = 2;
    const [x, y] = wall.size[0] < wall.size[1] ? [1, 0] : [0, 1];
    const across = new Vector3(x, y, 0).applyAxisAngle(new Vector3(0, 0, 1), wall.heading);
    this.walls.push({ mesh, across });
    this.group.add(mesh);
  }
}

function floor(): Mesh {
  const size = 6 * EXTENT;
  // nothing is below it, and nothing fights with it
  const mesh = new Mesh(new PlaneGeometry(size, size), new MeshLambertMaterial({ color: FLOOR, depthWrite: false }));
  mesh.receiveShadow = true;
  mesh.renderOrder = -2;
  return mesh;
}

/** Lines in short pieces: some software renderers drop a line that passes behind the eye. */
function grid(step: number, opacity: number): LineSegments {
  const ends: number[] = [];
  for (let i = -EXTENT; i <= EXTENT; i += step) {
    if (step === 1 && i % COARSE === 0) continue;
    for (let j = -EXTENT; j < EXTENT; j += PIECE) ends.push(j, i, 0, j + PIECE, i, 0, i, j, 0, i, j + PIECE, 0);
  }
  const shape = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  const paint = new LineBasicMaterial({ color: GRID, transparent: true, opacity, depthWrite: false });
  return new LineSegments(shape, paint);
}

/** The floor of the corridor, brighter than the rest. */
function lane(scene: Scene, graphics: Graphics): Mesh {
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
  const look = { color: LANE, depthWrite: false };
  const mesh = new Mesh(shape, graphics === "light" ? new MeshBasicMaterial(look) : new MeshLambertMaterial(look));
  mesh.receiveShadow = graphics === "full";
  mesh.position.z = scene.floor ?? 0;
  mesh.renderOrder = -1;
  return mesh;
}

/** From a corner of a line to the left edge of a band of a half width, where the edges of both sides meet. */
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
  const [low, high] = [new Color(HAZE), new Color(ZENITH)];
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
