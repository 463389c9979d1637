// A flight in real time, pushed by the page. As `live.session.session` does it. A ghost may fly along: another flight
// of the same vehicle, which takes each step with the same hand.

import type { PageMessage, Phase, SceneEnding, ServerMessage, StatusRefusals } from "../wire/messages.generated.ts";
import { Layout } from "../wire/frames.ts";
import { same } from "../wire/parameters.ts";
import type { Comparing, FlownScene, FlownStatus } from "../wire/source.ts";
import type { FlownMission } from "./flown_mission.ts";
import { HandControl, type Message } from "./hand_control.ts";
import type { Setting } from "./link.ts";
import type { PageManifest } from "./manifest.ts";
import { checkMessage } from "./message_rules.ts";
import { Pacer } from "./pacer.ts";
import { Refusal } from "./refusal.ts";
import { endingOf, refusalsNow } from "./status_texts.ts";

export type Answer = Exclude<ServerMessage, { type: "scene" | "status" | "pong" | "done" }> | SceneAnswer | SavedFile;

/** What is done with each message of a page. */
type Handlers = { [T in PageMessage["type"]]: (message: Message<T>) => void };
const OF_THE_HAND: readonly string[] = ["grab", "move", "release", "force"];

export interface SceneAnswer extends FlownScene {
  type: "scene";
}

/** A file that the page offers to the person. */
export interface SavedFile {
  type: "saved";
  name: string;
  bytes: Uint8Array<ArrayBuffer>;
}

export class Session {
  readonly pacer: Pacer;
  private ghost: FlownMission | null = null;
  private begun = 0; // ghosts
  private swaps = 0;
  private hand!: HandControl;
  private failed = false;
  private lastGrab = 0;
  private readonly layout: Layout;
  private readonly handlers = this.handlersOf();

  constructor(
    private own: FlownMission,
    clock: () => number, // s
    private readonly answer: (answer: Answer) => void,
  ) {
    this.pacer = new Pacer(own.module.manifest.dt, this.page.pacing, clock);
    this.layout = new Layout(this.page.scene.fields);
    this.takeHand();
  }

  /** Flies some steps, at most to the end of the flight; how many. */
  fly(steps: number): number {
    const { flight } = this.own;
    const before = flight.step;
    try {
      while (flight.step < before + steps && !flight.over && !this.failed) {
        this.hand.expireRequests();
        this.advance();
      }
    } catch (error) {
      this.failed = true; // until a reset
      console.error(error);
    }
    return flight.step - before;
  }

  get scene(): FlownScene {
    const { own, ghost, begun, swaps } = this;
    if (!ghost) return own.scene;
    const { mission, controller, parameters } = ghost.scene;
    return { ...own.scene, ghost: { mission, controller, parameters, begun, swaps } };
  }

  /** The latest frame, and that of the ghost after it. */
  frame(): Float32Array<ArrayBuffer> {
    const { own, ghost, layout } = this;
    const frame = new Float32Array(layout.size * (ghost ? 2 : 1));
    own.write(frame);
    ghost?.write(frame.subarray(layout.size));
    frame[layout.place("seq").start] = this.hand.seq % 2 ** 24;
    return frame;
  }

  status(): FlownStatus {
    const { own, ghost, pacer, hand } = this;
    const ending = ended(own);
    const behind = pacer.mostBehind;
    pacer.mostBehind = 0;
    const score = own.run?.score;
    return {
      type: "status",
      phase: this.phase(ending),
      alarm: this.page.scene.alarms[own.value("alarm")[0] ?? 0],
      enabled: hand.part("enabled")[0] !== 0,
      paused: pacer.paused,
      speed: pacer.speed,
      factor: Number(pacer.factor.toFixed(3)),
      behind_ms: Number((1e3 * behind).toFixed(2)),
      recorded_s: Number(own.flight.time.toFixed(3)),
      failed_rotors: own.parameters.failed(own.flight.time),
      tare_left_s: Number(hand.tareLeft.toFixed(3)),
      refusals: this.refusals(),
      ending,
      viewers: 1,
      holder: this.held ? "you" : "none",
      last_grab: this.lastGrab,
      ...(score && { score }),
      ...(ghost && { ghost: ended(ghost)?.text ?? "" }),
    };
  }

  /** Whether the person pulls or pushes. */
  get held(): boolean {
    return this.hand.holds || this.hand.pushes;
  }

  release(): void {
    this.hand.release();
  }

  /** Takes the settings of a link, and begins again with those that are allowed; the others and why they are not. */
  take(settings: readonly Setting[]): Answer[] {
    const refused: Answer[] = [];
    for (const [key, value] of settings) {
      try {
        this.own.parameters.set(this.own.flight, key, value);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        refused.push({ type: "refused", what: "link", reason: error.message });
      }
    }
    this.again();
    return refused;
  }

  /** Does what a message says, and answers. */
  apply(message: PageMessage, seq: number): void {
    checkMessage(message, this.page);
    if (OF_THE_HAND.includes(message.type)) this.hand.seq = seq;
    if (message.type === "grab") this.lastGrab = seq;
    (this.handlers[message.type] as (message: PageMessage) => void)(message);
  }

  /** Keeps the flight as it is as the ghost, changes places with the ghost, or lets it go. */
  compare(what: Exclude<Comparing, "fly">): void {
    const { own, ghost } = this;
    if (what === "keep") this.begin(own.twin());
    if (what === "end") this.ghost = null;
    if (what === "swap" && ghost) {
      this.hand.open();
      [this.own, this.ghost] = [ghost, own];
      this.swaps += 1;
      this.takeHand();
      this.hand.open();
    }
    this.answer({ type: "scene", ...this.scene });
  }

  /** Begins again beside another mission as the ghost. */
  accompany(ghost: FlownMission): void {
    const { vehicle, step } = ghost.scene;
    const reason = (what: string): string => `${ghost.scene.mission}: has ${what} than ${this.own.scene.mission}`;
    if (!same(vehicle, this.own.scene.vehicle)) throw new Refusal(reason("another vehicle"));
    if (step !== this.own.scene.step) throw new Refusal(reason("longer or shorter steps"));
    this.begin(ghost);
    this.reset();
  }

  private begin(ghost: FlownMission): void {
    this.ghost = ghost;
    this.begun += 1;
  }

  private handlersOf(): Handlers {
    const answerAll = (answers: readonly Answer[]): void => answers.forEach((one) => this.answer(one));
    return {
      grab: (message) => this.hand.grab(message, this.own.value("attitude")),
      move: (message) => this.hand.move(message),
      release: () => this.hand.release(),
      force: (message) => this.hand.push(message),
      ask: (message) => this.ask(message),
      enable: ({ on }) => this.takingRequests("enable").enable(on),
      set: ({ key, value }) => answerAll(this.own.parameters.set(this.own.flight, key, value)),
      restore: ({ key }) => answerAll(this.own.parameters.restore(this.own.flight, key)),
      kill: ({ rotor }) => this.own.parameters.stopRotor(this.own.flight, rotor),
      reset: () => this.reset(),
      rewind: ({ time }) => this.rewind(time),
      save: ({ name }) => this.answer({ type: "saved", name: `${name}.zip`, bytes: this.own.saved(name) }),
      tare: (message) => this.refuse(message),
      fly: (message) => this.refuse(message),
      turn: (message) => this.refuse(message),
      compare: ({ what }) => this.compare(what),
      ping: () => undefined,
      pause: ({ on }) => (this.pacer.paused = on),
      speed: ({ factor }) => (this.pacer.speed = factor),
    };
  }

  private get page(): PageManifest {
    return this.own.manifest.page;
  }

  /** Refuses what only a server has. */
  private refuse({ type }: PageMessage): never {
    throw new Refusal(this.page.texts.only_server, { what: type });
  }

  private ask(message: Message<"ask">): void {
    this.takingRequests(message.what).ask(message);
    const reason = message.what === "stop" ? "" : this.refusals()[message.what];
    if (reason) this.answer({ type: "refused", what: message.type, reason });
  }

  /** The hand, if the pilot takes requests. */
  private takingRequests(what: string): HandControl {
    const { no_requests: none } = this.page.texts;
    if (none) throw new Refusal(none, { what });
    return this.hand;
  }

  private again(): void {
    this.own.again();
    this.ghost?.again();
    this.takeHand();
  }

  private reset(): void {
    this.again();
    this.answer({ type: "scene", ...this.scene });
  }

  /** Flies again to a time with what was pushed and changed until then, and stands still there. */
  private rewind(time: number): void {
    const steps = Math.round(time / this.own.module.manifest.dt) + 1;
    this.pacer.paused = true;
    for (const one of [this.own, this.ghost]) one?.refly(one, steps);
    this.takeHand();
    this.hand.open();
    this.answer({ type: "scene", ...this.scene });
  }

  private refusals(): StatusRefusals {
    const { own, page, failed } = this;
    const { refused_at_end: end } = page.texts;
    if (failed) return end.error;
    if (own.flight.lost) return end.stopped_early;
    return own.flight.over ? end.over : refusalsNow(own.module, page, own.flight);
  }

  /** The hand is at the flight that the page shows. */
  private takeHand(): void {
    this.hand = new HandControl(this.own.flight, this.own.module, this.page);
    this.failed = false;
  }

  /** Takes a step; the ghost takes it too, with the same hand, unless it has ended before. */
  private advance(): void {
    const { own, ghost } = this;
    const { step, recorded } = own.flight;
    const moved = recorded.at(-1);
    if (ghost?.flight.step === step && !ghost.flight.over) {
      if (moved?.step === step) ghost.flight.hold(moved.hand);
      ghost.advance();
    }
    own.advance();
  }

  private phase(ending: SceneEnding | null): Phase {
    if (this.failed) return "failed";
    if (ending) return ending.outcome;
    return this.own.flight.over ? "over" : this.page.scene.phases[this.own.value("phase")[0]];
  }
}

function ended({ module, manifest, flight }: FlownMission): SceneEnding | null {
  return endingOf(module, manifest.page, flight);
}
