// Holds the beam by mouse or touch, and pulls it in a plane that faces the camera or is level.

import { type PerspectiveCamera, Vector2, Vector3 } from "three";

import {
  add,
  depthAfterWheel,
  dot,
  meetLevelPlane,
  meetPlane,
  nearestToRay,
  type Ray,
  scale,
  size,
  subtract,
  toBody,
  toWorld,
} from "../math/vectors.ts";
import type { HandView } from "../view/picture.ts";
import type { Axis } from "../view/vehicle.ts";
import type { Frame } from "../wire/frames.ts";
import type { PageMessage, Vector } from "../wire/messages.generated.ts";
import { shaken, TAP } from "./force_input.ts";
import type { HandOptions } from "./options.ts";

const MARGIN = 0.07; // m around the beam within which it can be held
const FINGER = 30; // pixels around it, for a finger
const CURSOR = 12; // pixels around it, for a mouse
const LINE = 33; // pixels of a line, for wheels that count lines
const FAR = 40; // m from the eye: a level plane ends there
const STILL = 1e-4; // m: a smaller move is not sent
const MOVE_INTERVAL = 7; // ms between two moves at least: some mice report a thousand a second

interface Held {
  pointer: number;
  point: Vector; // body: what the spring pulls at
  offset: Vector; // world: from the cursor in its plane to the target
  depth: number; // of the plane from the eye [m], if it faces the eye
  height: number | null; // of the plane [m], if it is level
  target: Vector;
  seq: number; // of the message that began it; a shake begins none, and no status ends it
  shakenFrom: Vector | null; // world: the first target, if the spring's force from there on is the peak of a shake
}

/** What a grab needs of the page. */
export interface GrabContext {
  camera: PerspectiveCamera;
  surface: HTMLElement;
  frame(): Frame | null;
  axis(): Axis | null;
  stiffness(): number; // of the spring [N/m]
  readonly options: HandOptions;
  send(message: PageMessage, since: number): number | null;
}

export class Grab {
  private held: Held | null = null;
  private cursor = new Vector2();
  private stamp = 0;
  private sent = 0;
  private over: Vector | null = null; // body: where the cursor could hold the beam
  private second: { pointer: number; y: number } | null = null;

  constructor(private readonly page: GrabContext) {
    const { surface } = page;
    const early = { capture: true, passive: false };
    surface.addEventListener("pointerdown", this.down, early);
    surface.addEventListener("pointermove", this.move, early);
    surface.addEventListener("pointerrawupdate", this.moveNow as EventListener, early);
    surface.addEventListener("wheel", this.wheel, early);
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      surface.addEventListener(kind, this.up, early);
    }
    surface.addEventListener("pointerleave", () => (this.over = null));
    // dead man's switch: a page without the focus does not hold the beam
    window.addEventListener("blur", this.release);
    document.addEventListener("visibilitychange", this.release);
  }

  get pulling(): boolean {
    return this.held !== null;
  }

  get hand(): HandView {
    if (this.held) return { kind: "pull", point: this.held.point, target: this.held.target };
    return this.over ? { kind: "offer", point: this.over } : { kind: "none" };
  }

  /** Sends at most one move, to where the cursor is as the camera stands now. */
  flush(): void {
    if (!this.held) return;
    const { held } = this;
    const target = this.targetOf(held);
    if (!target || size(subtract(target, held.target)) < STILL) return;
    held.target = target;
    this.sent = performance.now();
    const force = held.shakenFrom && scale(subtract(target, held.shakenFrom), this.page.stiffness());
    const shake = force && ({ type: "force", force, point: held.point, ...shaken(this.page.options) } as const);
    this.page.send(shake ?? { type: "move", target }, this.stamp || this.sent);
    this.stamp = 0;
  }

  release = (): void => {
    if (!this.held) return;
    this.cancel();
    this.page.send({ type: "release" }, performance.now());
  };

  /** Lets go without a message: the server has let go already; only of a grab that it knew of if `known` is given. */
  cancel(known = Infinity): void {
    if (!this.held || this.held.seq > known) return;
    const { pointer } = this.held;
    this.held = this.second = this.over = null;
    if (this.page.surface.hasPointerCapture(pointer)) this.page.surface.releasePointerCapture(pointer);
    this.page.surface.classList.remove("pulling");
  }

  private readonly down = (event: PointerEvent): void => {
    if (this.held) {
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
    this.begin(event, place);
  };

  private begin(event: PointerEvent, place: Vector): void {
    const frame = this.page.frame()!;
    const centre = this.page.options.at === "centre";
    const point: Vector = centre ? [0, 0, 0] : place;
    const world = add(frame.vector("position"), toWorld(frame.attitude, place));
    const eye = this.page.camera.position.toArray();
    const depth = dot(subtract(world, eye), this.ahead());
    const height = this.page.options.plane === "level" ? world[2] : null;
    const hit = this.hit(depth, height) ?? world;
    const target = add(frame.vector("position"), toWorld(frame.attitude, point));
    const { kind, force } = this.page.options;
    if (kind === "tap") {
      const away = scale(this.ray().direction, force);
      this.page.send({ type: "force", force: away, point, duration: TAP }, event.timeStamp);
      return;
    }
    const grab = { type: "grab", point, target, at: centre ? "centre" : "point" } as const;
    const seq = kind === "shake" ? Infinity : (this.page.send(grab, event.timeStamp) ?? 0);
    this.page.surface.setPointerCapture(event.pointerId);
    this.held = { pointer: event.pointerId, point, offset: subtract(target, hit), depth, height, target, seq, shakenFrom: kind === "shake" ? target : null };
    this.page.surface.classList.add("pulling");
  }

  private readonly move = (event: PointerEvent): void => {
    if (this.held) event.stopImmediatePropagation();
    if (this.second?.pointer === event.pointerId) {
      this.shiftPlane(2 * (event.clientY - this.second.y));
      this.second.y = event.clientY;
    }
    if (this.held && event.pointerId !== this.held.pointer) return;
    this.note(event);
    if (this.held || event.pointerType !== "mouse") return;
    this.over = event.buttons ? null : this.pick(CURSOR);
    this.page.surface.classList.toggle("over", this.over !== null);
  };

  /** Sends a move with the event, where the browser reports it before the next picture. */
  private readonly moveNow = (event: PointerEvent): void => {
    if (event.pointerId !== this.held?.pointer || performance.now() - this.sent < MOVE_INTERVAL) return;
    this.note(event);
    this.flush();
  };

  private readonly up = (event: PointerEvent): void => {
    if (this.second?.pointer === event.pointerId) this.second = null;
    if (this.held?.pointer !== event.pointerId) return;
    event.stopImmediatePropagation();
    this.release();
  };

  private readonly wheel = (event: WheelEvent): void => {
    if (!this.held) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    const pixels = event.deltaMode ? LINE * event.deltaY : event.deltaY;
    this.shiftPlane(Math.max(-300, Math.min(300, pixels)));
    this.stamp ||= event.timeStamp;
  };

  private note(event: PointerEvent): void {
    const box = this.page.surface.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.cursor.set(2 * x - 1, 1 - 2 * y);
    this.stamp ||= event.timeStamp;
  }

  private targetOf(held: Held): Vector | null {
    const hit = this.hit(held.depth, held.height);
    return hit && add(hit, held.offset);
  }

  private hit(depth: number, height: number | null): Vector | null {
    return height === null ? meetPlane(this.ray(), this.ahead(), depth) : meetLevelPlane(this.ray(), height, FAR);
  }

  /** Moves the plane of the hand: away from the eye, or up. */
  private shiftPlane(pixels: number): void {
    const held = this.held!;
    const deep = depthAfterWheel(held.depth, pixels);
    if (held.height === null) held.depth = deep;
    else held.height += 0.3 * (deep - held.depth);
  }

  /** The point of the beam's axis under the cursor, body axes; null if the cursor is not near it. */
  private pick(pixels: number): Vector | null {
    const [frame, axis] = [this.page.frame(), this.page.axis()];
    if (!frame || !axis) return null;
    const ray = this.ray();
    const inBody: Ray = {
      origin: toBody(frame.attitude, subtract(ray.origin, frame.vector("position"))),
      direction: toBody(frame.attitude, ray.direction),
    };
    const { point, gap, depth } = nearestToRay(inBody, axis.from, axis.to);
    const { camera, surface } = this.page;
    const perPixel = (2 * depth * Math.tan((camera.fov * Math.PI) / 360)) / surface.clientHeight;
    return gap < Math.max(axis.radius + MARGIN, axis.radius + pixels * perPixel) ? point : null;
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
