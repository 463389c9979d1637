// All rotors of the vehicle: blades, the blur of their discs, and an arrow for the thrust of each.

import {
  BoxGeometry,
  type BufferGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  FrontSide,
  Group,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Vector3,
} from "three";

import type { FlightScene, SceneQuadrotor, SceneShape } from "../wire/messages.generated.ts";
import type { Graphics } from "./graphics.ts";
import { inTheme } from "./palette.ts";
import { placeOf } from "./shapes.ts";

const TURN = 26; // rad/s as shown at full thrust; the true speed would be a blur
const TALL = 0.45; // m, length of the arrow at full thrust
const STOPPED = 0.01; // fraction of full thrust below which the blades stand still
const [CALM, HARD] = ["#1f9d76", "#d5281b"];
const AXIS = new Vector3(0, 0, 1);
const FRONT = "#e8641b"; // of parts in front (engines/models/visuals.py)

interface Place {
  blades: SceneShape;
  still: Matrix4; // of the blades
  hub: Vector3;
  radius: number;
  spin: number;
  most: number;
  angle: number;
}

/** Whether a rotor is in front of its quadrotor's centre, wherever the quadrotor faces. */
export function ahead(quadrotor: SceneQuadrotor, rotor: number): boolean {
  return quadrotor.rotors[rotor].disc.color === FRONT;
}

export class Rotors {
  readonly group = new Group();
  readonly arrows = new Group();
  private readonly places: Place[];
  private readonly blades: InstancedMesh;
  private readonly discs: InstancedMesh;
  private readonly shafts: InstancedMesh;
  private readonly heads: InstancedMesh;
  private readonly calm = new Color(CALM);
  private readonly hard = new Color(HARD);

  constructor(scene: FlightScene, graphics: Graphics) {
    const rotors = scene.vehicle.quadrotors.flatMap((quadrotor) => quadrotor.rotors);
    this.places = rotors.map(({ blades, radius, spin, max_thrust: most }) => {
      return { blades, still: placeOf(blades), hub: new Vector3(...blades.position), radius, spin, most, angle: 0 };
    });
    const sides = graphics === "full" ? 12 : 6;
    this.blades = this.instances(new BoxGeometry(1, 1, 1), new MeshLambertMaterial());
    this.discs = this.instances(new CircleGeometry(1, 28), seenThrough(0.26, true));
    this.shafts = this.instances(onFoot(new CylinderGeometry(1, 1, 1, sides)), seenThrough(0.85));
    this.heads = this.instances(onFoot(new ConeGeometry(1, 1, sides)), seenThrough(0.85));
    this.blades.castShadow = graphics === "full";
    this.arrows.add(this.shafts, this.heads);
    this.group.add(this.blades, this.discs, this.arrows);
    rotors.forEach(({ blades, disc }, i) => {
      this.blades.setColorAt(i, new Color(inTheme(blades.color)));
      this.discs.setColorAt(i, new Color(disc.color));
    });
  }

  /** Shows thrusts [N] after `passed` seconds of flight. */
  update(thrusts: Float32Array, passed: number): void {
    this.places.forEach((place, i) => {
      const share = Math.min(Math.max((thrusts[i] ?? 0) / place.most, 0), 1.2);
      if (share > STOPPED) place.angle -= place.spin * TURN * Math.sqrt(share) * passed;
      const turn = new Matrix4().makeRotationZ(place.angle);
      this.blades.setMatrixAt(i, place.still.clone().multiply(turn).scale(new Vector3(...place.blades.size)));
      const radius = share > STOPPED ? place.radius : 0;
      this.discs.setMatrixAt(i, new Matrix4().makeScale(radius, radius, radius).setPosition(place.hub));
      this.arrow(i, place, share);
    });
    for (const mesh of [this.blades, this.discs, this.shafts, this.heads]) mesh.instanceMatrix.needsUpdate = true;
    for (const mesh of [this.shafts, this.heads]) mesh.instanceColor!.needsUpdate = true; // the others keep theirs
  }

  private arrow(i: number, { hub, radius }: Place, share: number): void {
    const width = 0.06 * radius;
    const head = Math.min(TALL * share, 0.5 * radius);
    const shaft = TALL * share - head;
    const foot = hub.clone().addScaledVector(AXIS, 0.1 * radius);
    this.shafts.setMatrixAt(i, stretched(foot, width, shaft));
    this.heads.setMatrixAt(i, stretched(foot.addScaledVector(AXIS, shaft), 2.6 * width, head));
    const color = this.calm.clone().lerp(this.hard, Math.min(Math.max((share - 0.6) / 0.35, 0), 1));
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

function stretched(foot: Vector3, width: number, height: number): Matrix4 {
  return new Matrix4().makeScale(width, width, Math.max(height, 1e-4)).setPosition(foot);
}
