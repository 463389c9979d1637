// Lecture mode: full screen, large type, one quantity in the spotlight, and the steps of a prepared script.

import { typing } from "../hand/force_input.ts";
import type { View } from "../view/camera.ts";
import type { Frame } from "../wire/frames.ts";
import type { PageMessage, SceneMission, StatusMessage } from "../wire/messages.generated.ts";
import { same } from "../wire/parameters.ts";
import type { Compare, FlownScene } from "../wire/source.ts";
import { button, byId, el } from "./dom.ts";
import { checkScript, type LectureScript, type LectureStep } from "./lecture_script.ts";
import { readScript, refuse, ScriptError } from "./lecture_script.ts";
import { Spotlight } from "./spotlight.ts";

const [NEXT, BACK] = [["PageDown", "ArrowRight", "ArrowDown", "Space"], ["PageUp", "ArrowLeft", "ArrowUp"]];
const NO_SCRIPT = "Page Down and Page Up change the quantity. Drop a script (.toml) for the steps of a lecture.";
const EVERY = 100; // ms between two looks at the quantity

/** What a lecture needs of the page. */
export interface LecturePage {
  readonly current: Frame | null;
  readonly compare: Compare | undefined;
  readonly companions: readonly SceneMission[] | undefined;
  send(message: PageMessage): void;
}

/** What a lecture does with the rest of the page. */
export interface LectureActions {
  look: (view: View) => void;
  choose: () => void; // a file
  tell: (title: string, reason: string) => void;
}

export class Lecture {
  readonly button = button("screen", "Lecture, full screen (T)", "Large type, a script", () => this.toggle());
  scene!: FlownScene; // with the settings as they are now
  private readonly spotlight = new Spotlight();
  private readonly title = el("span");
  private readonly text = el("p", { class: "text", role: "status" });
  private readonly element: HTMLElement;
  private script: LectureScript | null = null;
  private waiting: [name: string, script: LectureScript] | null = null; // until its mission is flown
  private at = -1;
  private given = document.getElementById("script")?.textContent; // that the page has come with
  private push: { from: number; until: number } | null = null; // s
  private drawn = 0; // ms

  constructor(
    private readonly page: LecturePage,
    private readonly actions: LectureActions,
  ) {
    const nav = el("nav", {},
      button("open", "Script", "Open the script of a lecture: a .toml file", actions.choose),
      button("back", "Back", "The step before (Page Up)", () => this.turn(-1)),
      button("play", "Next", "The next step (Page Down, space)", () => this.turn(1)),
      button("close", "Leave", "Back to the whole page (T, Escape)", () => this.toggle()),
    );
    nav.addEventListener("click", () => (document.activeElement as HTMLElement).blur()); // space is the next step
    const words = el("div", { class: "words" }, el("header", {}, this.title, nav), this.text);
    this.element = el("section", { id: "lecture", hidden: true }, words, this.spotlight.element);
    byId("view").after(this.element);
    window.addEventListener("keydown", this.key, { capture: true }); // before those that push
    document.addEventListener("fullscreenchange", () => {
      if (this.on && !document.fullscreenElement) this.toggle();
    });
  }

  /** Begins or ends the mode. */
  toggle(): void {
    const on = !this.on;
    this.element.hidden = !on;
    document.body.classList.toggle("lecture", on);
    this.tell();
    if (on) fill();
    else this.release();
    if (!on && document.fullscreenElement) void document.exitFullscreen();
  }

  /** Takes a script, after another mission if it is for that; says why if it is refused. */
  load(name: string, text: string): void {
    this.unlessWrong(name, () => {
      const script = readScript(text);
      const { mission = this.scene.mission } = script;
      const known = this.page.companions?.map((one) => one.name).concat(this.scene.mission);
      if (known && !known.includes(mission)) refuse("mission", mission, `one of this page: ${known.join(", ")}`);
      if (mission === this.scene.mission) this.begin(name, script);
      else {
        this.waiting = [name, script];
        this.page.send({ type: "fly", mission });
      }
    });
  }

  /** A flight begins. */
  begun(): void {
    this.push = null;
    if (this.waiting?.[1].mission !== this.scene.mission) return;
    const [name, script] = this.waiting;
    this.waiting = null;
    this.unlessWrong(name, () => this.begin(name, script));
  }

  status({ preparing }: StatusMessage): void {
    if (preparing || !this.given) return;
    const { name, text } = JSON.parse(this.given) as { name: string; text: string };
    this.given = undefined;
    this.load(name, text);
  }

  frame(frame: Frame): void {
    this.spotlight.frame(frame);
    const time = frame.scalar("time");
    if (this.push && (time >= this.push.until || time < this.push.from)) this.release();
  }

  tick(now: number): void {
    if (!this.on || now - this.drawn < EVERY || !this.page.current) return;
    this.drawn = now;
    this.spotlight.draw(this.page.current);
  }

  private get on(): boolean {
    return !this.element.hidden;
  }

  private unlessWrong(name: string, act: () => void): void {
    try {
      act();
    } catch (error) {
      if (!(error instanceof ScriptError)) throw error;
      this.actions.tell("This script is not shown", `${name}: ${error.message}`);
    }
  }

  private begin(name: string, script: LectureScript): void {
    checkScript(script, this.scene);
    [this.script, this.at] = [{ title: name, ...script }, -1];
    this.turn(1);
    if (!this.on) this.toggle();
  }

  /** Goes to a step after or before this one; without a script, to another quantity. */
  private turn(by: number): void {
    const { steps } = this.script ?? {};
    if (!steps) this.spotlight.turn(by);
    else if (steps[this.at + by] as LectureStep | undefined) {
      this.at += by;
      this.go(steps, by > 0);
    }
    this.tell();
  }

  /** Does what a step says, and undoes what only later ones say; pushes and requests only on the way forward. */
  private go(steps: LectureStep[], forward: boolean): void {
    const { page, scene } = this;
    const past = steps.slice(0, this.at + 1);
    const { pause = false, push, ask, ghost } = past.at(-1)!;
    this.release();
    if (forward && ghost) page.compare?.(ghost);
    else if (!forward && scene.ghost && last(past, "ghost") !== "keep") page.compare?.("end");
    this.set(steps, past);
    this.spotlight.show(last(past, "spotlight") ?? "push");
    const view = past.at(-1)!.camera ?? (forward ? undefined : last(past, "camera"));
    if (view) this.actions.look(view);
    page.send({ type: "pause", on: pause });
    if (forward && ask) page.send({ type: "ask", what: ask });
    if (!forward || !push) return;
    const from = page.current?.scalar("time") ?? 0;
    this.push = { from, until: from + push.duration };
    page.send({ type: "force", force: push.force, point: [0, 0, 0] });
  }

  /** The settings of all steps so far; those of later steps are again the mission's. */
  private set(steps: LectureStep[], past: LectureStep[]): void {
    const wanted = Object.assign({}, ...past.map(({ settings }) => settings)) as LectureStep["settings"];
    for (const { key, value: now, initial = now } of this.scene.parameters) {
      if (!steps.some(({ settings }) => key in settings)) continue;
      const one = wanted[key] ?? initial;
      const value = Array.isArray(now) && typeof one === "number" ? now.map(() => one) : one;
      if (!same(value, now)) this.page.send({ type: "set", key, value });
    }
  }

  private release(): void {
    if (this.push) this.page.send({ type: "force", force: [0, 0, 0], point: [0, 0, 0] });
    this.push = null;
  }

  private tell(): void {
    const { title = "", steps } = this.script ?? {};
    this.title.textContent = steps ? `${title} \u00b7 ${this.at + 1} of ${steps.length}` : "Lecture";
    this.text.textContent = steps ? steps[this.at].text : NO_SCRIPT;
  }

  private readonly key = (event: KeyboardEvent): void => {
    if (!this.on || typing(event) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.code === "Escape") this.toggle();
    const by = Number(NEXT.includes(event.code)) - Number(BACK.includes(event.code));
    if (!by || (event.code === "Space" && (event.target as Element).matches("button, input"))) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (event.repeat) return;
    if (!document.fullscreenElement) fill();
    this.turn(by);
  };
}

/** What the last step that says something of a key says. */
function last<K extends keyof LectureStep>(past: LectureStep[], key: K): LectureStep[K] | undefined {
  return past.filter((step) => step[key] !== undefined).at(-1)?.[key];
}

/** Fills the screen, where the browser lets a page do it. */
function fill(): void {
  const page: Partial<HTMLElement> = document.documentElement;
  page.requestFullscreen?.call(page).catch(() => undefined);
}
