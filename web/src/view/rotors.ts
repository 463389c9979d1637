// All rotors of the vehicle: blades, the blur of their discs, and an arrow for the thrust of each.

import {
  BufferGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  FrontSide,
  Group,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  Vector3,
} from "three";

import type { FlightScene } from "../wire/messages.generated.ts";
import type { Graphics } from "./graphics.ts";
import { FRONT, REAR, palette } from "./palette.ts";
import { ahead, hubHeight } from "./quadrotor.ts";

const TURN = 26; // rad/s as shown at full thrust; the true speed would be a blur
const TALL = 0.45; // m, length of the arrow at full thrust
const STOPPED = 0.01; // fraction of full thrust below which the blades stand still
const CALM = new Color("#1f9d76");
const HARD = new Color("#d5281b");
const AXIS = new Vector3(0, 0, 1);

interface Place {
  hub: Vector3;
  radius: number;
  spin: number;
  most: number;
  color: Color;
  angle: number;
}

export class Rotors {
  readonly group = new Group();
  readonly arrows = new Group();
  private readonly places: Place[];
  private readonly blades: InstancedMesh;
  private readonly discs: InstancedMesh;
  private readonly shafts: InstancedMesh;
  private readonly heads: InstancedMesh;

  constructor(scene: FlightScene, graphics: Graphics) {
    this.places = scene.vehicle.quadrotors.flatMap((quadrotor) =>
      quadrotor.rotors.map((rotor, i) => ({
        hub: new Vector3(rotor.position[0], rotor.position[1], hubHeight(quadrotor, i)),
        radius: rotor.radius,
        spin: rotor.spin,
        most: rotor.max_thrust,
        color: new Color(ahead(quadrotor, i) ? FRONT : REAR),
        angle: 0.7 + i,
      })),
    );
    const sides = graphics === "full" ? 12 : 6;
    this.blades = this.instances(bladePair(), new MeshLambertMaterial({ color: palette.carbon, side: DoubleSide }));
    this.discs = this.instances(new CircleGeometry(1, 28), seenThrough(0.26, true));
    this.shafts = this.instances(onFoot(new CylinderGeometry(1, 1, 1, sides)), seenThrough(0.85));
    this.heads = this.instances(onFoot(new ConeGeometry(1, 1, sides)), seenThrough(0.85));
    this.blades.castShadow = graphics === "full";
    this.arrows.add(this.shafts, this.heads);
    this.group.add(this.blades, this.discs, this.arrows);
    this.places.forEach(({ color }, i) => {
      this.discs.setColorAt(i, color);
    });
  }

  /** Shows thrusts [N] after `passed` seconds of flight. */
  update(thrusts: Float32Array, passed: number): void {
    this.places.forEach((place, i) => {
      const share = Math.min(Math.max((thrusts[i] ?? 0) / place.most, 0), 1.2);
      if (share > STOPPED) place.angle -= place.spin * TURN * Math.sqrt(share) * passed;
      this.blades.setMatrixAt(i, turnedAt(place.hub, place.angle, place.radius));
      this.discs.setMatrixAt(i, turnedAt(place.hub, 0, share > STOPPED ? place.radius : 0));
      this.arrow(i, place, share);
    });
    for (const mesh of [this.blades, this.discs, this.shafts, this.heads]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }

  private arrow(i: number, { hub, radius }: Place, share: number): void {
    const width = 0.06 * radius;
    const head = Math.min(TALL * share, 0.5 * radius);
    const shaft = TALL * share - head;
    const foot = hub.clone().addScaledVector(AXIS, 0.1 * radius);
    this.shafts.setMatrixAt(i, stretched(foot, width, shaft));
    this.heads.setMatrixAt(i, stretched(foot.addScaledVector(AXIS, shaft), 2.6 * width, head));
    const color = CALM.clone().lerp(HARD, Math.min(Math.max((share - 0.6) / 0.35, 0), 1));
    this.shafts.setColorAt(i, color);
    this.heads.setColorAt(i, color);
  }

  private instances(shape: BufferGeometry, material: MeshBasicMaterial | MeshLambertMaterial): InstancedMesh {
    const mesh = new InstancedMesh(shape, material, this.places.length);
    mesh.frustumCulled = false;
    return mesh;
  }
}

function seenThrough(opacity: number, flat = false): MeshBasicMaterial {
  const side = flat ? DoubleSide : FrontSide;
  return new MeshBasicMaterial({ transparent: true, opacity, depthWrite: false, side, forceSinglePass: true });
}

/** A shape along y about its middle, turned to stand along z on its foot. */
function onFoot(shape: BufferGeometry): BufferGeometry {
  return shape.rotateX(Math.PI / 2).translate(0, 0, 0.5);
}

function turnedAt(hub: Vector3, angle: number, scale: number): Matrix4 {
  const turn = new Quaternion().setFromAxisAngle(AXIS, angle);
  return new Matrix4().compose(hub, turn, new Vector3(scale, scale, scale));
}

function stretched(foot: Vector3, width: number, height: number): Matrix4 {
  return new Matrix4().makeScale(width, width, Math.max(height, 1e-4)).setPosition(foot);
}

/** Two blades of radius 1 that taper and twist from root to tip. */
function bladePair(): BufferGeometry {
  const corners: number[] = [];
  const faces: number[] = [];
  const STATIONS = 7;
  for (const side of [1, -1]) {
    const first = corners.length / 3;
    for (let i = 0; i < STATIONS; i++) {
      const r = 0.08 + (0.9 * i) / (STATIONS - 1);
      const chord = 0.09 * Math.sin(Math.PI * Math.min(0.25 + 0.7 * r, 0.97)) + 0.02;
      const pitch = 0.5 - 0.35 * r;
      const [dy, dz] = [chord * Math.cos(pitch), chord * Math.sin(pitch)];
      corners.push(side * r, side * -dy, -dz, side * r, side * dy, dz);
      if (i) faces.push(...[0, 1, 2, 2, 1, 3].map((k) => first + 2 * (i - 1) + k));
    }
  }
  const shape = new BufferGeometry();
  shape.setAttribute("position", new Float32BufferAttribute(corners, 3));
  shape.setIndex(faces);
  shape.computeVertexNormals();
  return shape;
}
