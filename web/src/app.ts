// Connects the parts: what comes from the flight goes to the picture, what a person does goes to the flight.

import { Matrix4 } from "three";

import { ForceInput } from "./hand/force_input.ts";
import { Grab } from "./hand/grab.ts";
import type { HandOptions } from "./hand/options.ts";
import { Remarks } from "./hand/remarks.ts";
import { forgetColors } from "./ui/colors.ts";
import { byId } from "./ui/dom.ts";
import { Shell, type ShellPage } from "./ui/shell.ts";
import { rememberedShown } from "./ui/show_menu.ts";
import { type ThemeChoice, ThemeSwitch } from "./ui/theme.ts";
import { ChaseCamera, type View } from "./view/camera.ts";
import { FrameRate, type Graphics, type GraphicsChoice, suitableGraphics } from "./view/graphics.ts";
import { labelsIn } from "./view/labels.ts";
import { setPalette, type Theme } from "./view/palette.ts";
import { Picture } from "./view/picture.ts";
import { Rest } from "./view/rest.ts";
import { Stage } from "./view/stage.ts";
import { beamAxis } from "./view/vehicle.ts";
import type { Frame } from "./wire/frames.ts";
import { Latency } from "./wire/latency.ts";
import {
  type PageMessage,
  type ParameterValue,
  type SceneEnding,
  type SceneMission,
  STIFFNESS,
  THRESHOLD,
} from "./wire/messages.generated.ts";
import { perAxis } from "./wire/parameters.ts";
import type { Replay } from "./wire/replay.ts";
import type { Compare, FlightListener, FlightSource, FlownScene, FlownStatus } from "./wire/source.ts";

const REDRAW_AFTER = 100; // ms: overlays may have been switched although nothing moved

export class App implements FlightListener, ShellPage {
  readonly hand: HandOptions = { at: "point", plane: "facing", kind: "push", frequency: 4, force: 3, directions: "view" };
  readonly shown = rememberedShown();
  readonly latency = new Latency();
  readonly frameRate = new FrameRate();
  readonly camera: ChaseCamera;
  readonly compare: Compare | undefined;
  current: Frame | null = null;
  graphicsChoice: GraphicsChoice = "auto";
  private readonly stage: Stage;
  private readonly themes = new ThemeSwitch((theme) => this.recolor(theme));
  private readonly grab: Grab;
  private readonly force: ForceInput;
  private readonly shell: Shell;
  private readonly remarks = new Remarks();
  private readonly rest = new Rest((now) => this.tick(now));
  private readonly labels = labelsIn(byId("labels"));
  private picture: Picture | null = null;
  private last = 0;
  private drawn: Frame | null = null;
  private drawnAt = 0;
  private readonly eye = new Matrix4();
  private end: SceneEnding | null = null;
  private seat = -1; // the quadrotor on whose board the camera was last

  constructor(
    private readonly source: FlightSource,
    readonly replay: Replay | null,
    readonly extra: HTMLElement[] = [],
  ) {
    const surface = byId("surface");
    this.stage = new Stage(surface, suitableGraphics());
    const camera = this.stage.camera;
    const send = (message: PageMessage, since: number): number | null => this.send(message, since);
    this.grab = new Grab({
      camera,
      surface,
      send,
      options: this.hand,
      frame: () => this.current,
      stiffness: () => this.picture?.stiffness ?? 0,
      axis: () => (this.picture && !this.replay ? beamAxis(this.picture.scene.vehicle.payload) : null),
    });
    this.camera = new ChaseCamera(camera, surface);
    this.force = new ForceInput(camera, this.hand, send, replay === null);
    this.compare = source.compare?.bind(source);
    this.shell = new Shell(this);
  }

  start(): void {
    this.source.start(this);
    this.rest.start();
  }

  /** Shows a sentence that stays. */
  explain(sentence: string): void {
    this.shell.explain(sentence);
  }

  // ShellPage

  retry(): void {
    this.source.retry?.();
  }

  /** Sends a message; its number. Its delay is measured if it began with a person's event at `since` [ms]. */
  send(message: PageMessage, since?: number): number | null {
    const seq = this.source.send(message);
    if (seq !== null && since !== undefined) this.latency.note(seq, since, performance.now());
    return seq;
  }

  get companions(): readonly SceneMission[] | undefined {
    return this.source.companions;
  }

  get canvas(): HTMLCanvasElement {
    return this.stage.canvas;
  }

  get graphics(): Graphics {
    return this.stage.graphics;
  }

  look(view: View): void {
    if (!this.picture) return;
    const { center, reach, scene } = this.picture;
    if (view !== "board") {
      this.camera.look(view, center, reach, scene.corridor !== null);
      return;
    }
    this.seat = (this.seat + 1) % scene.vehicle.quadrotors.length;
    this.camera.board(scene.vehicle.quadrotors[this.seat].position);
  }

  setGraphics(choice: GraphicsChoice): void {
    this.graphicsChoice = choice;
    this.rebuild(choice === "auto" ? suitableGraphics() : choice);
  }

  get theme(): ThemeChoice {
    return this.themes.choice;
  }

  setTheme(choice: ThemeChoice): void {
    this.themes.choose(choice);
  }

  // FlightListener

  scene(scene: FlownScene): void {
    const first = this.picture === null;
    this.grab.release();
    this.current = null;
    this.picture?.remove();
    const paths = this.picture?.scene.mission === scene.mission ? this.picture.trails : undefined;
    this.picture = new Picture(scene, this.stage, this.labels, paths);
    this.shell.scene(scene);
    if (!first) return;
    // where the vehicle stands is known with the first frame; until then, near the origin
    this.picture.center.set(0, 0, 1);
    this.look("behind");
  }

  frame(frame: Frame): void {
    if (!frame.drawable) return;
    if (!this.current) this.picture?.center.set(...frame.vector("position"));
    this.current = frame;
    this.shell.frame(frame);
    this.rest.look(this.drawn, frame, this.mayRest);
  }

  status(status: FlownStatus): void {
    if (status.holder !== "you") this.grab.cancel(status.last_grab); // the server has let go
    this.remarks.status(status);
    this.end = status.ending;
    this.shell.status(status);
  }

  changed(key: string, value: ParameterValue, duration: number): void {
    if (this.picture && key === THRESHOLD) this.picture.threshold = perAxis(value);
    if (this.picture && key === STIFFNESS) this.picture.stiffness = Number(value);
    this.shell.changed(key, value, duration);
  }

  refused(what: string, reason: string): void {
    if (["grab", "force"].includes(what)) {
      this.remarks.refuse(reason, this.grab.hand);
      this.grab.release(); // and says so: the refusal may be of an earlier grab than the server knows by now
      if (what === "force") this.force.refuse();
      return;
    }
    this.shell.refused(what, reason);
  }

  done(what: string, detail: string): void {
    this.shell.done(what, detail);
  }

  disconnected(retryAt: number): void {
    this.grab.cancel();
    this.shell.disconnected(retryAt);
  }

  connected(): void {
    this.shell.connected();
  }

  /** Whether a vehicle that only turns its rotors may be drawn rarely. */
  private get mayRest(): boolean {
    return this.graphics === "light" && !this.replay;
  }

  private tick(now: number): void {
    const { current, drawn } = this;
    const busy = !current || this.shell.recording || this.moved();
    const resting = !busy && this.rest.suits(drawn, current, this.mayRest);
    this.rest.next(resting);
    const passed = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    this.source.tick?.(now);
    if (this.current && this.picture) this.draw(this.current, this.picture, now, passed);
    this.shell.tick(now);
    const slow = this.frameRate.tick(now, this.drawnAt === now, resting);
    if (slow && this.graphicsChoice === "auto" && !this.shell.recording) this.rebuild("light");
  }

  private draw(frame: Frame, picture: Picture, now: number, passed: number): void {
    picture.update(frame, this.grab.hand, this.shown, this.remarks.now(frame));
    picture.showEnding(this.end ? `${this.end.outcome} here, ${this.end.time.toFixed(2)} s` : "", this.end?.place ?? null);
    const along = frame.ghost?.drawable ? frame.ghost : null;
    picture.rival.show(along ? along.pose : this.shell.challenge.rival);
    this.camera.update(picture.vehicle.group, this.grab.pulling, passed);
    this.grab.flush();
    this.force.flush(this.grab.pulling);
    // the same picture again would keep the processor from receiving what is new
    if (frame === this.drawn && !this.moved() && now - this.drawnAt <= REDRAW_AFTER) return;
    picture.draw();
    if (!this.drawn) performance.mark("first picture");
    [this.drawn, this.drawnAt] = [frame, now];
    this.eye.copy(this.stage.camera.matrixWorld);
    this.latency.drawn(frame.scalar("seq"), performance.now());
  }

  /** Whether the camera stands elsewhere than in the last picture. */
  private moved(): boolean {
    this.stage.camera.updateMatrixWorld();
    return !this.eye.equals(this.stage.camera.matrixWorld);
  }

  /** Continues at another level of graphics, on another canvas: a video of this one ends, and is saved. */
  private rebuild(graphics: Graphics): void {
    if (graphics === this.stage.graphics) return;
    this.shell.endVideo();
    this.stage.build(graphics);
    this.repaint();
  }

  /** Takes the colours of a theme; the first time before there is a stage. */
  private recolor(theme: Theme): void {
    setPalette(theme);
    forgetColors();
    (this.stage as Stage | undefined)?.recolor();
    this.repaint();
  }

  /** Makes the picture anew, of the same scene. */
  private repaint(): void {
    if (!this.picture) return;
    const { scene, threshold, stiffness, trails } = this.picture;
    this.picture.remove();
    this.picture = new Picture(scene, this.stage, this.labels, trails);
    Object.assign(this.picture, { threshold, stiffness });
    this.drawn = null;
  }
}
