// The shadow of light graphics: the vehicle projected on the floor along the sun's rays.

import { type BufferGeometry, Matrix4, Mesh, MeshBasicMaterial, type Object3D, Vector3 } from "three";

import { palette } from "./palette.ts";

export const SUN = new Vector3(0.35, -0.42, 0.84).normalize();

export class FlatShadow {
  readonly mesh: Mesh;
  private readonly press: Matrix4;

  constructor(solid: BufferGeometry, floor: number) {
    this.mesh = new Mesh(solid, new MeshBasicMaterial({ color: palette.shade }));
    this.mesh.matrixAutoUpdate = false;
    this.mesh.frustumCulled = false;
    const [x, y] = [SUN.x / SUN.z, SUN.y / SUN.z];
    const flat = 0.001; // of the height is kept, so that the parts keep their order
    const up = floor + 0.002;
    this.press = new Matrix4().set(1, 0, -x, x * floor, 0, 1, -y, y * floor, 0, 0, flat, up - flat * floor, 0, 0, 0, 1);
  }

  place(body: Object3D): void {
    body.updateMatrixWorld();
    this.mesh.matrix.multiplyMatrices(this.press, body.matrixWorld);
  }
}
