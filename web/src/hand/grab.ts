// Taking hold of the beam with mouse or touch, and pulling it in the plane that faces the camera.

import { type PerspectiveCamera, Vector2, Vector3 } from "three";

import type { Hand } from "../view/picture.ts";
import type { Axis } from "../view/vehicle.ts";
import type { Outgoing, Vector } from "../wire/protocol.ts";
import {
  add,
  deeper,
  dot,
  less,
  nearestToRay,
  onLevel,
  onPlane,
  type Ray,
  size,
  turned,
  unturned,
} from "./geometry.ts";
import type { Frame } from "../wire/frames.ts";

const FAT = 0.07; // m around the beam where it can be taken hold of
const FINGER = 30; // pixels around it for a finger
const CURSOR = 12; // pixels around it for a mouse
const LINE = 33; // pixels of a line, for wheels that count lines
const FAR = 40; // m from the eye: a level plane ends there
const STILL = 1e-4; // m: a smaller move is not sent
const APART = 7; // ms between two moves at least: mice tell of up to a thousand a second

interface Grip {
  pointer: number;
  point: Vector; // body: what the spring pulls at
  offset: Vector; // world: from the cursor in its plane to the target
  depth: number; // of the plane from the eye [m], if it faces the eye
  height: number | null; // of the plane [m], if it is level
  target: Vector;
}

/** What a grab needs to know of the page. */
export interface Reach {
  camera: PerspectiveCamera;
  surface: HTMLElement;
  frame(): Frame | null;
  axis(): Axis | null;
  atCentre(): boolean;
  level(): boolean;
  send(message: Outgoing, since: number): void;
}

export class Grab {
  private grip: Grip | null = null;
  private cursor = new Vector2();
  private stamp = 0;
  private sent = 0;
  private over: Vector | null = null; // body: where the cursor could take hold
  private second: { pointer: number; y: number } | null = null;

  constructor(private readonly page: Reach) {
    const { surface } = page;
    const early = { capture: true, passive: false };
    surface.addEventListener("pointerdown", this.down, early);
    surface.addEventListener("pointermove", this.move, early);
    surface.addEventListener("pointerrawupdate", this.hurry as EventListener, early);
    surface.addEventListener("wheel", this.wheel, early);
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      surface.addEventListener(kind, this.up, early);
    }
    surface.addEventListener("pointerleave", () => (this.over = null));
    // the dead man's handle: nobody who looks away holds the beam
    window.addEventListener("blur", this.release);
    document.addEventListener("visibilitychange", this.release);
  }

  get pulling(): boolean {
    return this.grip !== null;
  }

  get hand(): Hand {
    if (this.grip) return { kind: "pull", point: this.grip.point, target: this.grip.target };
    return this.over ? { kind: "offer", point: this.over } : { kind: "none" };
  }

  /** Sends at most one move, to where the cursor is as the camera stands now. */
  flush(): void {
    if (!this.grip) return;
    const target = this.targetOf(this.grip);
    if (!target || size(less(target, this.grip.target)) < STILL) return;
    this.grip.target = target;
    this.sent = performance.now();
    this.page.send({ type: "move", target }, this.stamp || this.sent);
    this.stamp = 0;
  }

  release = (): void => {
    if (!this.grip) return;
    this.cancel();
    this.page.send({ type: "release" }, performance.now());
  };

  /** Lets go without a word: the server knows already. */
  cancel(): void {
    if (!this.grip) return;
    const { pointer } = this.grip;
    this.grip = this.second = this.over = null;
    if (this.page.surface.hasPointerCapture(pointer)) this.page.surface.releasePointerCapture(pointer);
    this.page.surface.classList.remove("pulling");
  }

  private readonly down = (event: PointerEvent): void => {
    if (this.grip) {
      // a second finger sets the depth
      this.second = { pointer: event.pointerId, y: event.clientY };
      event.stopImmediatePropagation();
      return;
    }
    if (event.button !== 0 || event.shiftKey || event.ctrlKey) return;
    this.note(event);
    const place = this.pick(event.pointerType === "mouse" ? CURSOR : FINGER);
    if (!place) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    (document.activeElement as HTMLElement | null)?.blur();
    this.page.surface.setPointerCapture(event.pointerId);
    this.take(event, place);
  };

  private take(event: PointerEvent, place: Vector): void {
    const frame = this.page.frame()!;
    const centre = this.page.atCentre();
    const point: Vector = centre ? [0, 0, 0] : place;
    const world = add(frame.vector("position"), turned(frame.attitude, place));
    const eye = this.page.camera.position.toArray();
    const depth = dot(less(world, eye), this.ahead());
    const height = this.page.level() ? world[2] : null;
    const hit = this.hit(depth, height) ?? world;
    const target = add(frame.vector("position"), turned(frame.attitude, point));
    this.grip = { pointer: event.pointerId, point, offset: less(target, hit), depth, height, target };
    this.page.surface.classList.add("pulling");
    this.page.send({ type: "grab", point, target, at: centre ? "centre" : "point" }, event.timeStamp);
  }

  private readonly move = (event: PointerEvent): void => {
    if (this.grip) event.stopImmediatePropagation();
    if (this.second?.pointer === event.pointerId) {
      this.reach(2 * (event.clientY - this.second.y));
      this.second.y = event.clientY;
    }
    if (this.grip && event.pointerId !== this.grip.pointer) return;
    this.note(event);
    if (this.grip || event.pointerType !== "mouse") return;
    this.over = event.buttons ? null : this.pick(CURSOR);
    this.page.surface.classList.toggle("over", this.over !== null);
  };

  /** A move goes out as soon as the mouse tells of it, where the browser says so before the next picture. */
  private readonly hurry = (event: PointerEvent): void => {
    if (event.pointerId !== this.grip?.pointer || performance.now() - this.sent < APART) return;
    this.note(event);
    this.flush();
  };

  private readonly up = (event: PointerEvent): void => {
    if (this.second?.pointer === event.pointerId) this.second = null;
    if (this.grip?.pointer !== event.pointerId) return;
    event.stopImmediatePropagation();
    this.release();
  };

  private readonly wheel = (event: WheelEvent): void => {
    if (!this.grip) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    const pixels = event.deltaMode ? LINE * event.deltaY : event.deltaY;
    this.reach(Math.max(-300, Math.min(300, pixels)));
    this.stamp ||= event.timeStamp;
  };

  private note(event: PointerEvent): void {
    const box = this.page.surface.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.cursor.set(2 * x - 1, 1 - 2 * y);
    this.stamp ||= event.timeStamp;
  }

  private targetOf(grip: Grip): Vector | null {
    const hit = this.hit(grip.depth, grip.height);
    return hit && add(hit, grip.offset);
  }

  private hit(depth: number, height: number | null): Vector | null {
    return height === null ? onPlane(this.ray(), this.ahead(), depth) : onLevel(this.ray(), height, FAR);
  }

  /** Moves the hand across its plane: away from the eye, or up. */
  private reach(pixels: number): void {
    const grip = this.grip!;
    const deep = deeper(grip.depth, pixels);
    if (grip.height === null) grip.depth = deep;
    else grip.height += 0.3 * (deep - grip.depth);
  }

  /** The point of the beam's axis under the cursor, body axes; null if the cursor is not near it. */
  private pick(pixels: number): Vector | null {
    const [frame, axis] = [this.page.frame(), this.page.axis()];
    if (!frame || !axis) return null;
    const ray = this.ray();
    const inBody: Ray = {
      origin: unturned(frame.attitude, less(ray.origin, frame.vector("position"))),
      direction: unturned(frame.attitude, ray.direction),
    };
    const { point, gap, depth } = nearestToRay(inBody, axis.from, axis.to);
    const { camera, surface } = this.page;
    const perPixel = (2 * depth * Math.tan((camera.fov * Math.PI) / 360)) / surface.clientHeight;
    return gap < Math.max(axis.radius + FAT, axis.radius + pixels * perPixel) ? point : null;
  }

  private ray(): Ray {
    const { camera } = this.page;
    camera.updateMatrixWorld();
    const through = new Vector3(this.cursor.x, this.cursor.y, 0.5).unproject(camera).sub(camera.position).normalize();
    return { origin: camera.position.toArray(), direction: through.toArray() };
  }

  private ahead(): Vector {
    return this.page.camera.getWorldDirection(new Vector3()).toArray();
  }
}
