// The stage: renderer, light and camera, at the level of graphics that the machine can draw.

import {
  Color,
  ColorManagement,
  LinearSRGBColorSpace,
  SRGBColorSpace,
  DirectionalLight,
  Fog,
  HemisphereLight,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";

import type { Graphics } from "./graphics.ts";
import { palette } from "./palette.ts";
import { SUN } from "./shadow.ts";

const LIGHT_RATIO = 0.75; // in light graphics

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(42, 1, 0.05, 700);
  canvas!: HTMLCanvasElement;
  private renderer!: WebGLRenderer;
  private readonly sun = new DirectionalLight("#fffaf3");
  private readonly sky = new HemisphereLight("#e8eff8", "#9a9894");
  private readonly fog = new Fog(palette.haze, 20, 60);

  constructor(
    private readonly surface: HTMLElement,
    public graphics: Graphics,
  ) {
    this.camera.up.set(0, 0, 1);
    this.scene.fog = this.fog;
    this.scene.add(this.sky, this.sun, this.sun.target);
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.01;
    this.sun.shadow.radius = 3;
    this.build(graphics);
    new ResizeObserver(() => this.resize()).observe(surface);
  }

  /** Makes a new renderer: antialiasing of an existing one cannot be switched. */
  build(graphics: Graphics): void {
    this.graphics = graphics;
    const full = graphics === "full";
    // a processor would take a power of every colour of every layer of a pixel: a third of its time
    ColorManagement.enabled = full;
    [this.sun.intensity, this.sky.intensity] = full ? [2.3, 1.5] : [1.7, 2.6];
    this.recolor();
    const renderer = rendererOf(full);
    renderer.outputColorSpace = full ? SRGBColorSpace : LinearSRGBColorSpace;
    renderer.shadowMap.enabled = this.sun.castShadow = full;
    renderer.shadowMap.type = PCFShadowMap;
    if ((this.renderer as WebGLRenderer | undefined) !== undefined) {
      this.renderer.dispose();
      this.renderer.forceContextLoss();
      this.canvas.remove();
      this.sun.shadow.dispose();
      this.sun.shadow.map = null; // the old one belongs to the old renderer
    }
    this.renderer = renderer;
    this.canvas = renderer.domElement;
    this.surface.prepend(this.canvas);
    this.resize();
  }

  /** Takes the colours of the palette for what is far away. */
  recolor(): void {
    const far = this.graphics === "full" ? palette.haze : palette.pale;
    this.scene.background = new Color(far);
    this.fog.color.set(far);
  }

  /** Draws the surroundings of a vehicle of a reach [m]. */
  draw(vehicle: Vector3, reach: number): void {
    if (this.renderer.getPixelRatio() !== this.ratio) this.resize(); // the window is on another screen
    const apart = this.camera.position.distanceTo(vehicle);
    this.fog.near = apart + 8;
    this.fog.far = 1.5 * apart + 36;
    this.light(vehicle, 1.3 * reach + 1);
    this.renderer.render(this.scene, this.camera);
  }

  private light(vehicle: Vector3, half: number): void {
    this.sun.target.position.copy(vehicle);
    this.sun.position.copy(vehicle).addScaledVector(SUN, 12);
    const eye = this.sun.shadow.camera;
    if (eye.right === half) return;
    Object.assign(eye, { left: -half, right: half, bottom: -half, top: half, near: 1, far: 40 });
    eye.updateProjectionMatrix();
  }

  /** Pixels of the picture per pixel of the page. */
  private get ratio(): number {
    return this.graphics === "light" ? LIGHT_RATIO : Math.min(window.devicePixelRatio, 2);
  }

  private resize(): void {
    const [width, height] = [this.surface.clientWidth || 1, this.surface.clientHeight || 1];
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(width, height);
    this.renderer.render(this.scene, this.camera); // a canvas of a new size is black
  }
}

/** An opaque renderer: blending with the page behind it would cost the processor a third more. */
function rendererOf(antialias: boolean): WebGLRenderer {
  const canvas = document.createElement("canvas");
  const powerPreference = "high-performance";
  const context = canvas.getContext("webgl2", { alpha: false, antialias, stencil: false, powerPreference });
  return new WebGLRenderer({ canvas, antialias, ...(context && { context }) });
}
