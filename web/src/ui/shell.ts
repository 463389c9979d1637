// Everything around the picture: bar, panel, plots, buttons, notices, and the keys that press them.

import { typing } from "../hand/force_input.ts";
import type { ChaseCamera, View } from "../view/camera.ts";
import type { FrameRate, Graphics } from "../view/graphics.ts";
import type { Frame } from "../wire/frames.ts";
import type { Latency } from "../wire/latency.ts";
import type { PageMessage, ParameterValue, SceneMission, StatusMessage } from "../wire/messages.generated.ts";
import { withValue } from "../wire/parameters.ts";
import type { Replay } from "../wire/replay.ts";
import type { Compare, FlownScene, FlownStatus } from "../wire/source.ts";
import { Challenge } from "./challenge.ts";
import { Comparison } from "./comparison.ts";
import { Dock } from "./dock.ts";
import { byId, choice, foldable } from "./dom.ts";
import { timedName } from "./file_names.ts";
import { helpDialog } from "./help.ts";
import { handKinds } from "./hand_rows.ts";
import { EndedCard } from "./ended_card.ts";
import { Findings } from "./findings.ts";
import { hintOf } from "./hint.ts";
import { Laboratory } from "./laboratory.ts";
import { Lecture } from "./lecture.ts";
import { MissionChoice } from "./mission_choice.ts";
import { Notices } from "./notices.ts";
import { Panel, type PanelPage } from "./panel.ts";
import { Question } from "./question.ts";
import { ReplayDock } from "./replay_dock.ts";
import { SaveDialog } from "./save_dialog.ts";
import { SensesOfFlight } from "./senses.ts";
import { type Shown, ShowMenu } from "./show_menu.ts";
import { StatusBar } from "./status_bar.ts";
import { Undo } from "./undo.ts";
import { VideoRecorder } from "./video_recorder.ts";

const TEXT_EVERY = 200; // ms
const VIEWS: Record<View, string> = { behind: "behind", side: "side", above: "above", board: "on board" };
const NARROW = 900; // pixels: below it the panel starts closed
const LOW = 450; // pixels of height: below it the plots start closed

/** What the shell needs of the page. */
export interface ShellPage extends PanelPage {
  readonly replay: Replay | null;
  readonly shown: Shown;
  readonly camera: ChaseCamera;
  readonly canvas: HTMLCanvasElement;
  readonly graphics: Graphics;
  readonly latency: Latency;
  readonly frameRate: FrameRate;
  readonly current: Frame | null;
  readonly companions: readonly SceneMission[] | undefined;
  readonly compare: Compare | undefined;
  send(message: PageMessage): number | null;
  retry(): void;
  look(view: View): void;
}

export class Shell {
  private readonly notices: Notices;
  private readonly bar: StatusBar;
  private readonly panel: Panel;
  private readonly help: HTMLDialogElement;
  private readonly saving: SaveDialog;
  private readonly ended: EndedCard;
  private readonly missions: MissionChoice;
  private readonly findings: Findings;
  private readonly video = new VideoRecorder();
  private readonly laboratory: Laboratory;
  readonly challenge: Challenge;
  private readonly comparison: Comparison;
  private readonly lecture: Lecture;
  private readonly senses: SensesOfFlight;
  private readonly show: ShowMenu;
  private readonly undo: Undo;
  private dock: Dock | null = null;
  private player: ReplayDock | null = null;
  private readonly question = new Question();
  private mission = "flight";
  private floor = 0; // m
  private pulled = false;
  private texts = 0;

  constructor(private readonly page: ShellPage) {
    this.notices = new Notices(() => page.retry());
    this.findings = new Findings(this.notices);
    const load = (name: string, text: string): void => this.lecture.load(name, text);
    this.missions = new MissionChoice(page.send.bind(page), this.notices, this.question, load);
    this.lecture = new Lecture(page, {
      look: (view) => this.views()[Object.keys(VIEWS).indexOf(view)].click(),
      choose: () => this.missions.choose(),
      tell: (title, reason) => this.question.tell(title, reason),
    });
    this.bar = new StatusBar(page.replay !== null, page.companions !== undefined);
    this.undo = new Undo(page.send.bind(page));
    this.comparison = new Comparison(page.compare);
    this.panel = new Panel(byId("panel"), page, this.undo.element);
    this.laboratory = new Laboratory(page, (text) => this.notices.show(text, "done"));
    this.help = helpDialog(page.replay !== null);
    this.saving = new SaveDialog((name) => page.send({ type: "save", name }));
    byId("show-help").addEventListener("click", () => this.openHelp());
    foldable("show-panel", "panel", window.innerWidth >= NARROW && page.replay === null);
    foldable("show-plots", "plots", window.innerHeight >= LOW && window.parent === window); // a page around it has its own
    this.senses = new SensesOfFlight(page.shown);
    this.show = new ShowMenu(page.shown, (on) => (page.camera.following = on));
    this.makeViews();
    this.challenge = new Challenge((name) => this.saving.open(name), () => page.send({ type: "reset" }), (on) => this.panel.challenged(on));
    if (!page.replay) this.makeDock();
    this.ended = new EndedCard(() => page.send({ type: "reset" }));
    window.addEventListener("keydown", this.key);
  }

  /** Whether a video is being recorded. */
  get recording(): boolean {
    return this.video.running;
  }

  endVideo(): void {
    if (this.recording) this.toggleVideo();
  }

  scene(scene: FlownScene): void {
    [this.mission, this.floor] = [scene.mission, scene.floor];
    this.bar.scene(scene);
    this.panel.scene(scene);
    this.laboratory.show(scene);
    this.undo.scene(scene.parameters);
    this.missions.scene(scene);
    this.senses.begin(scene);
    this.challenge.begin(scene);
    this.comparison.begin(this.page.companions);
    this.tellSettings(scene);
    this.lecture.begun();
    this.dock?.reset(this.missions.open);
    if (!this.page.replay || !scene.replay) return;
    const { element } = this.laboratory.timeline;
    this.player = new ReplayDock(byId("dock"), scene.replay, this.page.replay, element, () => this.toggleVideo());
  }

  frame(frame: Frame): void {
    this.laboratory.frame(frame);
    this.bar.frame(frame);
    this.challenge.frame(frame);
    this.lecture.frame(frame);
    if (frame.scalar("held") > 0) this.pulled = true;
  }

  status(status: FlownStatus): void {
    this.bar.status(status);
    this.challenge.status(status);
    this.comparison.status(status);
    this.dock?.status(status);
    if (!this.page.replay) this.ended.status(status);
    this.lecture.status(status);
    this.panel.markFailed(status.failed_rotors);
    this.hint(status);
    this.findings.status(status.findings ?? []);
    this.laboratory.status(status);
  }

  changed(key: string, value: ParameterValue, duration: number): void {
    this.panel.changed(key, value, duration);
    this.laboratory.changed(key, value);
    this.challenge.changed(key, value);
    this.tellSettings({ ...this.lecture.scene, parameters: withValue(this.lecture.scene.parameters, key, value) });
    this.undo.changed(key, value, performance.now());
  }

  refused(what: string, reason: string): void {
    if (what === "save" && this.saving.refused(reason)) return;
    if (what === "fly") {
      this.missions.refused(reason);
      return;
    }
    if (["ask", "enable"].includes(what) && this.dock) {
      this.dock.refused(reason);
      return;
    }
    const shown = this.panel.refused(what, reason);
    if (!shown || byId("panel").hidden) this.notices.show(`${what}: ${reason}`, "refused");
  }

  done(what: string, detail: string): void {
    if (what === "fly") {
      this.missions.done(detail);
      return;
    }
    if (what === "save") this.saving.done();
    this.notices.show(what === "save" ? `Saved as ${detail}` : `${what}: ${detail}`, "done");
  }

  explain(sentence: string): void {
    this.notices.explain(sentence);
  }

  connected(): void {
    this.notices.connected();
  }

  disconnected(retryAt: number): void {
    this.notices.disconnected(retryAt);
    this.bar.disconnected();
    this.saving.refused("The connection is lost: the flight was not saved.");
  }

  /** After each picture. */
  tick(now: number): void {
    const { page } = this;
    this.laboratory.tick(now);
    this.lecture.tick(now);
    const { threshold } = this.laboratory;
    if (page.current && threshold) this.senses.update(page.current, threshold, now);
    if (page.current) this.player?.update(page.current.scalar("time"));
    if (now - this.texts < TEXT_EVERY) return;
    this.texts = now;
    this.challenge.tick();
    this.bar.update(page.current, page.latency.median, page.frameRate.rate);
    if (page.current) this.panel.showThrusts(page.current.list("thrusts"));
  }

  private makeDock(): void {
    const { page } = this;
    this.dock = new Dock(byId("dock"), page.send.bind(page), this.question, {
      height: () => (page.current ? page.current.vector("position")[2] - this.floor : null),
      open: () => this.missions.choose(),
      save: () => this.saving.open(timedName(this.mission)),
      film: () => this.toggleVideo(),
    });
    this.undo.element.append(this.comparison.menu);
    byId("dock").prepend(this.comparison.element, this.challenge.element);
    byId("dock").lastElementChild!.append(this.challenge.button);
  }

  /** The settings as they are now. */
  private tellSettings(scene: FlownScene): void {
    this.comparison.show(scene);
    this.lecture.scene = scene;
  }

  private views(): HTMLElement[] {
    return [...byId("views").querySelectorAll<HTMLElement>(".choice button")];
  }

  private makeViews(): void {
    const { page } = this;
    const views = choice("View", VIEWS, "behind", (view) => page.look(view));
    byId("views").replaceChildren(views, this.show.button, ...(page.replay ? [] : handKinds(page.hand)));
    byId("show").append(this.lecture.button);
  }

  private openHelp(): void {
    this.help.showModal();
    this.help.scrollTop = 0; // the focus is at its end
  }

  private toggleVideo(): void {
    let reason = "";
    if (this.video.running) this.video.stop();
    else reason = this.video.start(this.page.canvas, timedName(this.mission));
    if (reason) this.notices.show(reason, "refused");
    this.dock?.filming(this.video.running);
    byId("dock").classList.toggle("filming", this.video.running);
  }

  /** What to do first, until it was done. */
  private hint(status: StatusMessage): void {
    const hint = byId("hint");
    const text = hintOf(status, this.pulled);
    if (hint.textContent !== text) hint.textContent = text;
    hint.hidden = text === "" || this.page.replay !== null;
  }

  private readonly key = (event: KeyboardEvent): void => {
    if (this.undo.key(event)) event.preventDefault();
    if (typing(event) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.repeat && !event.code.startsWith("Arrow")) return;
    this.keys().get(event.code)?.();
  };

  private keys(): Map<string, () => void> {
    const { player } = this;
    const keys = new Map(this.views().map((one, i) => [`Digit${i + 1}`, () => one.click()]));
    keys.set("KeyF", () => this.show.follow.click());
    keys.set("KeyT", () => this.lecture.toggle());
    if (player) {
      keys.set("KeyP", () => player.toggle());
      keys.set("ArrowLeft", () => player.step(-1));
      keys.set("ArrowRight", () => player.step(1));
    } else {
      keys.set("KeyP", () => this.dock?.togglePause());
      keys.set("KeyR", () => this.laboratory.rewind());
      keys.set("KeyL", () => this.dock?.ask("lift"));
      keys.set("KeyK", () => this.dock?.ask("land"));
    }
    return keys;
  }
}
