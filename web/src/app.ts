// Brings the parts together: what comes from the flight goes to the picture, what a person does goes to the flight.

import { Matrix4 } from "three";

import { Grab } from "./hand/grab.ts";
import { Pushes } from "./hand/pushes.ts";
import { byId } from "./ui/dom.ts";
import { Frontend } from "./ui/frontend.ts";
import { Follow, type View } from "./view/follow.ts";
import { type Choice, type Graphics, Pace, suited } from "./view/graphics.ts";
import { Label } from "./view/labels.ts";
import { Picture, type Shown } from "./view/picture.ts";
import { Stage } from "./view/stage.ts";
import { beamAxis } from "./view/vehicle.ts";
import type { Frame } from "./wire/frames.ts";
import { Latency } from "./wire/latency.ts";
import { type Outgoing, perAxis, type Scene, type Setting, type Status, THRESHOLD } from "./wire/protocol.ts";
import type { Recorded } from "./wire/recorded.ts";
import type { Listener, Source } from "./wire/source.ts";

const STIFFNESS = "person.stiffness"; // of the hand's spring
const STALE = 100; // ms, after which the same moment is drawn again: overlays may have been switched
const LET_GO = 3; // statuses of a grab that the server knows nothing of

export class App implements Listener {
  readonly shown: Shown = { push: true, zone: true, ghost: true, thrust: true, wind: true, trail: true };
  readonly latency = new Latency();
  readonly pace = new Pace();
  readonly follow: Follow;
  readonly pushes: Pushes;
  grabAt: "point" | "centre" = "point";
  plane: "facing" | "level" = "facing";
  current: Frame | null = null;
  private readonly stage: Stage;
  private readonly grab: Grab;
  private readonly front: Frontend;
  private readonly labels = { push: new Label(byId("labels"), "push"), wind: new Label(byId("labels"), "wind") };
  private picture: Picture | null = null;
  private graphics: Choice = "auto";
  private last = 0;
  private drawn: Frame | null = null;
  private drawnAt = 0;
  private readonly eye = new Matrix4();
  private unheld = 0;

  constructor(
    private readonly source: Source,
    readonly replay: Recorded | null,
  ) {
    const surface = byId("surface");
    this.stage = new Stage(surface, suited());
    const camera = this.stage.camera;
    const send = (message: Outgoing, since: number): void => {
      this.send(message, since);
    };
    this.grab = new Grab({
      camera,
      surface,
      send,
      frame: () => this.current,
      axis: () => (this.picture && !this.replay ? beamAxis(this.picture.scene.vehicle.payload) : null),
      atCentre: () => this.grabAt === "centre",
      level: () => this.plane === "level",
    });
    this.follow = new Follow(camera, surface);
    this.pushes = new Pushes(camera, send, replay === null);
    this.front = new Frontend(this);
  }

  start(): void {
    this.source.start(this);
    requestAnimationFrame(this.tick);
  }

  retry(): void {
    this.source.retry?.();
  }

  /** Sends a message; its delay is measured if it began with a hand's event at `since` [ms]. */
  send(message: Outgoing, since?: number): void {
    const seq = this.source.send(message);
    if (seq !== null && since !== undefined) this.latency.note(seq, since, performance.now());
  }

  get canvas(): HTMLCanvasElement {
    return this.stage.canvas;
  }

  get level(): Graphics {
    return this.stage.graphics;
  }

  look(view: View): void {
    if (this.picture) this.follow.look(view, this.picture.center, this.picture.reach);
  }

  setGraphics(choice: Choice): void {
    this.graphics = choice;
    this.rebuild(choice === "auto" ? suited() : choice);
  }

  // Listener

  scene(scene: Scene): void {
    const first = this.picture === null;
    this.grab.cancel();
    this.current = null;
    this.picture?.remove();
    this.picture = new Picture(scene, this.stage, this.labels);
    this.front.scene(scene);
    if (!first) return;
    // where the vehicle stands is known with the first frame; until then, near the origin
    this.picture.center.set(0, 0, 1);
    this.look("behind");
  }

  frame(frame: Frame): void {
    if (!frame.drawable) return;
    if (!this.current) this.picture?.center.set(...frame.vector("position"));
    this.current = frame;
    this.front.frame(frame);
  }

  status(status: Status): void {
    this.unheld = this.grab.pulling && status.holder !== "you" ? this.unheld + 1 : 0;
    if (this.unheld > LET_GO) this.grab.cancel(); // the server has let go
    this.front.status(status);
  }

  changed(key: string, value: Setting, duration: number): void {
    if (this.picture && key === THRESHOLD) this.picture.threshold = perAxis(value);
    if (this.picture && key === STIFFNESS) this.picture.stiffness = Number(value);
    this.front.changed(key, value, duration);
  }

  refused(what: string, reason: string): void {
    if (what.startsWith("grab")) this.grab.cancel();
    this.front.refused(what, reason);
  }

  done(what: string, detail: string): void {
    this.front.done(what, detail);
  }

  lost(retryAt: number | null): void {
    this.grab.cancel();
    this.front.lost(retryAt);
  }

  found(): void {
    this.front.found();
  }

  private readonly tick = (now: number): void => {
    requestAnimationFrame(this.tick);
    const passed = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    this.source.tick?.(now);
    const { current, picture } = this;
    if (current && picture) {
      picture.update(current, this.grab.hand, this.shown);
      this.follow.update(picture.center, this.grab.pulling, passed);
      this.grab.flush();
      this.pushes.flush(this.grab.pulling);
      // the same picture again would keep the processor from hearing of what is new
      if (current !== this.drawn || this.moved() || now - this.drawnAt > STALE) {
        picture.draw();
        [this.drawn, this.drawnAt] = [current, now];
        this.eye.copy(this.stage.camera.matrixWorld);
        this.latency.drawn(current.scalar("seq"), performance.now());
      }
    }
    this.front.tick(now);
    const slow = this.pace.tick(now, this.drawnAt === now);
    if (slow && this.graphics === "auto" && !this.front.filming) this.rebuild("light");
  };

  /** Whether the camera stands elsewhere than in the last picture. */
  private moved(): boolean {
    this.stage.camera.updateMatrixWorld();
    return !this.eye.equals(this.stage.camera.matrixWorld);
  }

  /** Draws on at another level of graphics. */
  private rebuild(graphics: Graphics): void {
    if (graphics === this.stage.graphics) return;
    this.stage.build(graphics);
    if (!this.picture) return;
    const { scene, threshold, stiffness } = this.picture;
    this.picture.remove();
    this.picture = new Picture(scene, this.stage, this.labels);
    Object.assign(this.picture, { threshold, stiffness });
  }
}
