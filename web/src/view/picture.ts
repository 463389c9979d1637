// The whole picture of a scene: everything that a frame moves, and overlays that may be switched off.

import { Group, Line, Mesh, Vector3 } from "three";

import { size } from "../math/vectors.ts";
import type { Frame } from "../wire/frames.ts";
import type { FlightScene, Vector } from "../wire/messages.generated.ts";
import { Arrow } from "./arrow.ts";
import { ContactMark } from "./contact.ts";
import { HandMarker } from "./hand.ts";
import type { Labels } from "./labels.ts";
import { Mark } from "./mark.ts";
import { palette } from "./palette.ts";
import { Person } from "./person.ts";
import { PushMark, pushText } from "./push.ts";
import { FlatShadow } from "./shadow.ts";
import type { Stage } from "./stage.ts";
import { Plumb, Trails } from "./trail.ts";
import { Ghost, Vehicle } from "./vehicle.ts";
import { World } from "./world.ts";

export type Overlay = "push" | "zone" | "ghost" | "thrust" | "wind" | "trail" | "trails" | "person";
export type Overlays = Record<Overlay, boolean>;

/** The hand of this page as it is drawn: none, over the beam, or pulling. */
export type HandView =
  { kind: "none" } | { kind: "offer"; point: Vector } | { kind: "pull"; point: Vector; target: Vector };

/** A sentence at a point of the body: why what a person does there has no effect. */
export interface Remark {
  text: string;
  point: Vector;
}

export class Picture {
  readonly vehicle: Vehicle;
  readonly center = new Vector3();
  readonly reach: number;
  threshold: Vector;
  stiffness: number;
  private readonly root = new Group();
  private readonly world: World;
  private readonly ghost: Ghost;
  readonly rival: Ghost;
  private readonly shadow: FlatShadow;
  private readonly push = new PushMark();
  private readonly wind = new Arrow(palette.wind, 0.014, 0.14, 0.1);
  private readonly hold = new HandMarker();
  private readonly end = new Mark(palette.push);
  private readonly contact = new ContactMark();
  private readonly person: Person;
  private readonly plumb: Plumb;
  private time = NaN;

  constructor(
    readonly scene: FlightScene,
    private readonly stage: Stage,
    private readonly labels: Labels,
    readonly trails = new Trails(),
  ) {
    this.vehicle = new Vehicle(scene, stage.graphics);
    this.world = new World(scene, stage.graphics);
    this.ghost = new Ghost(this.vehicle.outline);
    this.rival = new Ghost(this.vehicle.outline, palette.contact);
    this.rival.show(null);
    this.shadow = new FlatShadow(this.vehicle.outline, scene.floor);
    this.plumb = new Plumb(scene.floor);
    this.threshold = scene.threshold;
    this.stiffness = scene.spring.stiffness;
    this.reach = reachOf(scene);
    this.person = new Person(scene.floor, this.reach, stage.graphics);
    this.trails.begin();
    this.shadow.mesh.visible = scene.ground && stage.graphics === "light";
    const arrows = [this.push.group, this.wind.group, this.hold.group, this.end.group, this.contact.group];
    const lines = [this.trails.group, this.plumb.line];
    const bodies = [this.vehicle.group, this.ghost.group, this.rival.group, this.person.mesh];
    this.root.add(this.world.group, this.shadow.mesh, ...bodies, ...arrows, ...lines);
    stage.scene.add(this.root);
  }

  remove(): void {
    this.stage.scene.remove(this.root);
    this.trails.group.removeFromParent(); // the next picture may go on with it
    this.root.traverse((part) => {
      if (!(part instanceof Mesh || part instanceof Line)) return;
      const drawn = part as Mesh;
      drawn.geometry.dispose();
      for (const paint of [drawn.material].flat()) paint.dispose();
    });
    for (const label of Object.values(this.labels)) label.hide();
  }

  update(frame: Frame, hand: HandView, shown: Overlays, remark: Remark | null): void {
    const time = frame.scalar("time");
    const passed = Math.min(Math.max(time - this.time, 0), 0.1) || 0;
    if (time < this.time - 0.001 || time > this.time + 1) this.trails.begin();
    const position = frame.vector("position");
    this.vehicle.place(position, frame.attitude);
    this.vehicle.group.updateMatrixWorld();
    this.center.set(...position);
    this.vehicle.rotors.update(frame.list("thrusts"), passed);
    this.vehicle.rotors.arrows.visible = shown.thrust;
    this.trails.stay = shown.trails;
    if (time !== this.time) this.trails.add(position);
    this.trails.group.visible = this.plumb.line.visible = shown.trail;
    this.person.mesh.visible = shown.person;
    if (shown.person) this.person.accompany(this.center);
    this.plumb.place(position);
    this.shadow.place(this.vehicle.group);
    this.showReference(frame, position, shown.ghost);
    this.showForces(frame, shown);
    this.showHand(frame, hand, shown.zone);
    this.showContact(frame);
    if (remark) this.labels.refusal.show(remark.text, this.inWorld(remark.point), this.stage.camera);
    else this.labels.refusal.hide();
    this.time = time;
  }

  draw(): void {
    this.world.update(this.center, this.stage.camera.position);
    this.stage.draw(this.center, this.reach);
  }

  /** Where the flight ended, and what is said there. */
  showEnding(text: string, place: Vector | null): void {
    if (place) {
      this.end.show(new Vector3(...place));
      this.labels.ending.show(text, this.end.group.position, this.stage.camera);
    } else {
      this.end.hide();
      this.labels.ending.hide();
    }
  }

  /** A point of the body where it is in the world. */
  inWorld(point: Vector): Vector3 {
    return this.vehicle.group.localToWorld(new Vector3(...point));
  }

  private showReference(frame: Frame, position: Vector, shown: boolean): void {
    const reference = frame.vector("reference");
    const gap = Math.hypot(...reference.map((r, i) => r - position[i]));
    if (shown) this.ghost.place(reference, frame.scalar("reference_yaw"), gap);
    else this.ghost.group.visible = false;
  }

  private showForces(frame: Frame, shown: Overlays): void {
    const [push, wind] = [frame.vector("push"), frame.vector("wind")];
    const moment = new Vector3(...frame.vector("push_moment")).applyQuaternion(this.vehicle.group.quaternion);
    this.push.group.visible = shown.push;
    this.push.show(this.inWorld(frame.vector("push_point")), push, moment, shown.zone ? this.threshold : null);
    const above = this.center.clone().add(new Vector3(0, 0, 0.55 + 0.1 * this.reach));
    const half = new Vector3(...wind).multiplyScalar(0.07);
    this.wind.show(above.sub(half), shown.wind ? wind : [0, 0, 0]);
    const camera = this.stage.camera;
    const { arrow, moment: curved } = this.push;
    if (shown.push && arrow.visible) this.labels.push.show(pushText(push, this.threshold), arrow.tip, camera);
    else this.labels.push.hide();
    const turning = shown.push && curved.group.visible;
    if (turning) this.labels.moment.show(`${moment.length().toFixed(1)} N m`, curved.tip, camera);
    else this.labels.moment.hide();
    if (this.wind.visible) this.labels.wind.show(`wind ${size(wind).toFixed(1)} m/s`, this.wind.tip, camera);
    else this.labels.wind.hide();
  }

  private showContact(frame: Frame): void {
    const touching = this.contact.update(frame, this.scene.phases);
    if (touching) this.labels.contact.show(touching, this.contact.place, this.stage.camera);
    else this.labels.contact.hide();
  }

  private showHand(frame: Frame, hand: HandView, shown: boolean): void {
    const zone = shown ? this.zone() : null;
    if (hand.kind === "pull") this.hold.show(this.inWorld(hand.point), new Vector3(...hand.target), zone);
    else if (frame.scalar("held") > 0) {
      const target = new Vector3(...frame.vector("hand_target"));
      this.hold.show(this.inWorld(frame.vector("hand_point")), target, zone);
    } else if (hand.kind === "offer") this.hold.offer(this.inWorld(hand.point));
    else this.hold.hide();
  }

  /** Half the sides of the zone in which the spring pulls less than the threshold [m]. */
  private zone(): Vector3 | null {
    if (this.stiffness <= 0) return null;
    return new Vector3(...this.threshold).divideScalar(this.stiffness).clampScalar(0.003, 2);
  }
}

function reachOf(scene: FlightScene): number {
  const { quadrotors, payload } = scene.vehicle;
  const ways = quadrotors.flatMap((q) => q.rotors.map((r) => size(r.position) + r.radius));
  return Math.max(payload.length / 2, ...ways);
}
