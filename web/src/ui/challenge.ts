// The challenge of a corridor: score and parts while one flies, the best run so far, and the file to hand in.

import type { Pose } from "../view/vehicle.ts";
import type { Frame } from "../wire/frames.ts";
import type { FlightScene, ParameterValue, StatusMessage, StatusScore } from "../wire/messages.generated.ts";
import { same } from "../wire/parameters.ts";
import { button, el } from "./dom.ts";
import { timedName } from "./file_names.ts";
import { keep, keptData } from "./storage.ts";

const EVERY = 0.1; // s between the poses that are kept of a run
const PARTS = { time: "s", touches: "", effort: "N s", jerk: "", score: "s" } as const;
const RULE = "Fly from your first push to the end of the corridor. The lowest score wins: seconds, 5 a touch, 1 for 5 N s, 1 a unit of jerk. The hand moves level.";
const LATE = "This flight was pushed before: a new run counts from its first push.";
const POSE = 7; // numbers of a pose

interface Run {
  score: number; // s
  poses: number[]; // from the first push on
}

export class Challenge {
  readonly element = el("div", { id: "challenge", class: "refusal-row", hidden: true });
  readonly button: HTMLButtonElement;
  private readonly parts = new Map<keyof typeof PARTS, HTMLElement>();
  private readonly note = el("p", {}, RULE);
  private readonly actions: HTMLElement;
  private readonly handIn: HTMLElement;
  private on = false;
  private late = false; // asked for in a flight that was pushed before
  private scene: FlightScene | null = null;
  private score: StatusScore | null = null;
  private start = NaN; // s, of the first push that the page has seen
  private time = NaN;
  private poses: number[] = [];
  private best: Run | null = null;
  private readonly altered = new Map<string, boolean>();

  constructor(
    save: (name: string) => void,
    again: () => void,
    private readonly challenged: (on: boolean) => void,
  ) {
    this.button = button("flag", "Challenge", "Score a flight through the corridor", () => this.ask());
    const cells = (Object.keys(PARTS) as (keyof typeof PARTS)[]).map((name) => {
      const value = el("dd", {}, "\u2013");
      this.parts.set(name, value);
      return el("div", { class: name }, el("dt", {}, name), value);
    });
    this.handIn = button("save", "Save to hand in", "", () => save(timedName(`${this.scene!.mission}-${this.score!.score.toFixed(1)}s`)), "go");
    this.actions = el("div", { hidden: true }, this.handIn, button("reset", "New run", "Begin the flight again", again));
    this.element.append(el("div", { class: "strip" }, el("dl", {}, ...cells), this.note, this.actions));
  }

  begin(scene: FlightScene): void {
    this.scene = scene;
    this.best = (keptData(this.place) as Run | null) ?? null;
    this.altered.clear();
    for (const { key, value, initial } of scene.parameters) this.altered.set(key, !same(value, initial ?? value));
    this.restart();
    this.button.hidden = !scene.corridor;
    this.show(this.on);
  }

  changed(key: string, value: ParameterValue): void {
    const parameter = this.scene?.parameters.find((one) => one.key === key);
    if (parameter) this.altered.set(key, !same(value, parameter.initial ?? parameter.value));
  }

  frame(frame: Frame): void {
    const time = frame.scalar("time");
    if (time < this.time - 1e-4) this.rewind(time);
    this.time = time;
    if (Number.isNaN(this.start) && frame.vector("push").some((part) => part !== 0)) this.start = time;
    if (this.score?.finished || this.score?.refused || !(time >= this.start + (EVERY * this.poses.length) / POSE)) return;
    this.poses.push(...[...frame.vector("position"), ...frame.attitude].map((value) => Math.round(1e3 * value) / 1e3));
  }

  status(status: StatusMessage): void {
    const score = this.score?.refused ? this.score : status.score; // what is not ranked stands still
    const ended = score?.finished && !this.score?.finished;
    this.score = score ?? null;
    if (score) this.start = score.start;
    if (ended) this.end(score);
    this.offer();
  }

  /** With each picture: the clock; what was measured changes with the status. */
  tick(): void {
    if (this.element.hidden) return;
    const score = this.late ? null : this.score;
    const start = this.late ? NaN : this.start;
    const running = score?.finished || score?.refused ? score.time : this.time - start;
    for (const [name, value] of this.parts) {
      const number = name === "time" ? running : score?.[name];
      const text = number === undefined || Number.isNaN(number) ? "\u2013" : number.toFixed(name === "touches" ? 0 : 1);
      const whole = text === "\u2013" ? text : `${text} ${PARTS[name]}`;
      if (value.textContent !== whole) value.textContent = whole;
    }
    const note = this.remark();
    if (this.note.textContent !== note) this.note.textContent = note;
  }

  /** The best run at the moment of this one; null if there is none, or the challenge is off. */
  get rival(): Pose | null {
    const poses = this.best?.poses;
    if (this.element.hidden || this.late || !poses?.length) return null;
    const passed = Math.max((this.time - this.start || 0) / EVERY, 0);
    const first = Math.floor(passed);
    if (POSE * (first + 2) > poses.length) return null;
    const of = (i: number): number => {
      const [a, b] = [poses[POSE * first + i], poses[POSE * (first + 1) + i]];
      return a + (passed - first) * (b - a);
    };
    return { position: [of(0), of(1), of(2)], attitude: [of(3), of(4), of(5), of(6)] };
  }

  private get place(): string {
    return `tandemlift.best.${this.scene?.mission}`;
  }

  private remark(): string {
    const { score, best } = this;
    if (this.late) return LATE;
    if (score?.refused) return `Not ranked: ${score.refused}.`;
    const changed = [...this.altered].filter(([, on]) => on).map(([key]) => key);
    const settings = changed.length ? ` Changed settings count only if they are free: ${changed.join(", ")}.` : "";
    if (score?.finished) return score.score <= (best?.score ?? Infinity) ? `Your best run.${settings}` : `Your best: ${best!.score.toFixed(1)} s.${settings}`;
    return (best && !score ? `Your best: ${best.score.toFixed(1)} s; its ghost flies along. ` : score ? "" : RULE) + settings;
  }

  private end(score: StatusScore): void {
    if (!this.on || this.late || score.refused || score.score >= (this.best?.score ?? Infinity)) return;
    const poses = this.poses.slice(0, POSE * (Math.floor(score.time / EVERY) + 2));
    this.best = { score: score.score, poses };
    keep(this.place, JSON.stringify(this.best));
  }

  /** Back within the run: what was flown until then stays. */
  private rewind(time: number): void {
    if (!(time >= this.start)) {
      this.restart();
      return;
    }
    this.score = null;
    this.poses.length = Math.min(this.poses.length, POSE * Math.floor((time - this.start) / EVERY + 1));
  }

  private restart(): void {
    [this.start, this.time, this.score, this.poses, this.late] = [NaN, NaN, null, [], false];
    this.offer();
  }

  /** It begins with the next push: what was flown before it was asked for does not count. */
  private ask(): void {
    this.late = !Number.isNaN(this.start);
    this.show(!this.on);
    this.offer();
  }

  /** Offers to hand in a run that counts, and to begin another where none is in progress. */
  private offer(): void {
    const { score, late } = this;
    this.actions.hidden = !late && !score?.finished && !score?.refused;
    this.handIn.hidden = late || !score?.finished || score.refused !== "";
  }

  private show(on: boolean): void {
    this.on = on;
    this.button.setAttribute("aria-pressed", String(on));
    this.element.hidden = !on || !this.scene?.corridor;
    this.challenged(!this.element.hidden);
  }
}
