// A flight in real time, pushed by the page. As `live.session.session` does it.

import type {
  FlightScene,
  PageMessage,
  Phase,
  SceneEnding,
  ServerMessage,
  StatusMessage,
  StatusRefusals,
} from "../wire/messages.generated.ts";
import { Layout } from "../wire/frames.ts";
import { CorridorRun } from "./corridor_run.ts";
import { Flight } from "./flight.ts";
import { HandControl, type Message } from "./hand_control.ts";
import type { FlightManifest } from "./manifest.ts";
import { checkMessage } from "./message_rules.ts";
import { MissionNumbers } from "./mission_numbers.ts";
import type { FlightModule } from "./module.ts";
import { Pacer } from "./pacer.ts";
import { ParameterControl } from "./parameter_control.ts";
import { recordedFlight } from "./recording.ts";
import { Refusal } from "./refusal.ts";
import { endingOf, refusalsNow } from "./status_texts.ts";

export type Answer = Exclude<ServerMessage, { type: "status" | "pong" | "done" }> | SavedFile;

/** What is done with each message of a page. */
type Handlers = { [T in PageMessage["type"]]: (message: Message<T>) => void };
const OF_THE_HAND: readonly string[] = ["grab", "move", "release", "force"];

/** A file that the page offers to the person. */
export interface SavedFile {
  type: "saved";
  name: string;
  bytes: Uint8Array<ArrayBuffer>;
}

export class Session {
  readonly pacer: Pacer;
  private flight!: Flight;
  private hand!: HandControl;
  private parameters!: ParameterControl;
  private start!: MissionNumbers;
  private run: CorridorRun | null = null;
  private failed = false;
  private lastGrab = 0;
  private readonly layout: Layout;
  private readonly handlers = this.handlersOf();

  constructor(
    private readonly module: FlightModule,
    private readonly manifest: FlightManifest,
    clock: () => number, // s
    private readonly answer: (answer: Answer) => void,
  ) {
    this.pacer = new Pacer(module.manifest.dt, manifest.page.pacing, clock);
    this.layout = new Layout(manifest.page.scene.fields);
    this.begin(new MissionNumbers(manifest));
  }

  /** Flies some steps, at most to the end of the flight; how many. */
  fly(steps: number): number {
    const before = this.flight.step;
    try {
      while (this.flight.step < before + steps && !this.flight.over && !this.failed) {
        this.hand.expireRequests();
        this.advance();
      }
    } catch (error) {
      this.failed = true; // until a reset
      console.error(error);
    }
    return this.flight.step - before;
  }

  get scene(): FlightScene {
    const { scene } = this.manifest.page;
    const { now, parameters } = this.parameters;
    const number = (key: string): number => now.value(key) as number;
    const spring = {
      stiffness: number("person.stiffness"),
      damping: number("person.damping"),
      max_force: number("person.max_force"),
    };
    const threshold = now.value("admittance.threshold") as unknown as FlightScene["threshold"];
    return { ...scene, threshold, spring, parameters };
  }

  /** The latest frame. */
  frame(): Float32Array<ArrayBuffer> {
    const frame = new Float32Array(this.layout.size);
    this.eachValue((field, values) => frame.set(values, this.layout.place(field).start));
    const { hand } = this;
    const own = { held: "held", hand_point: "grip", hand_target: "target", push_point: "grip" } as const;
    for (const [field, part] of Object.entries(own)) {
      frame.set(hand.part(part), this.layout.place(field as keyof typeof own).start);
    }
    frame[this.layout.place("seq").start] = hand.seq % 2 ** 24;
    return frame;
  }

  status(): StatusMessage {
    const { flight, pacer, hand } = this;
    const ending = endingOf(this.module, this.manifest.page, flight);
    const behind = pacer.mostBehind;
    pacer.mostBehind = 0;
    const score = this.run?.score;
    return {
      type: "status",
      phase: this.phase(ending),
      alarm: this.manifest.page.scene.alarms[this.value("alarm")[0] ?? 0],
      enabled: hand.part("enabled")[0] !== 0,
      paused: pacer.paused,
      speed: pacer.speed,
      factor: Number(pacer.factor.toFixed(3)),
      behind_ms: Number((1e3 * behind).toFixed(2)),
      recorded_s: Number(flight.time.toFixed(3)),
      failed_rotors: this.parameters.failed(flight.time),
      tare_left_s: Number(this.hand.tareLeft.toFixed(3)),
      refusals: this.refusals(),
      ending,
      viewers: 1,
      holder: this.held ? "you" : "none",
      last_grab: this.lastGrab,
      ...(score && { score }),
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
  take(settings: readonly (readonly [key: string, value: number | string | readonly number[]])[]): Answer[] {
    const refused: Answer[] = [];
    for (const [key, value] of settings) {
      try {
        this.parameters.set(this.flight, key, value);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        refused.push({ type: "refused", what: "link", reason: error.message });
      }
    }
    this.begin(this.parameters.withWholeRotors());
    return refused;
  }

  /** Does what a message says, and answers. */
  apply(message: PageMessage, seq: number): void {
    checkMessage(message, this.manifest.page);
    if (OF_THE_HAND.includes(message.type)) this.hand.seq = seq;
    if (message.type === "grab") this.lastGrab = seq;
    (this.handlers[message.type] as (message: PageMessage) => void)(message);
  }

  private handlersOf(): Handlers {
    const answerAll = (answers: readonly Answer[]): void => answers.forEach((one) => this.answer(one));
    return {
      grab: (message) => this.hand.grab(message, this.value("attitude")),
      move: (message) => this.hand.move(message),
      release: () => this.hand.release(),
      force: (message) => this.hand.push(message),
      ask: (message) => this.ask(message),
      enable: ({ on }) => this.takingRequests("enable").enable(on),
      set: ({ key, value }) => answerAll(this.parameters.set(this.flight, key, value)),
      restore: ({ key }) => answerAll(this.parameters.restore(this.flight, key)),
      kill: ({ rotor }) => this.parameters.stopRotor(this.flight, rotor),
      reset: () => this.reset(),
      rewind: ({ time }) => this.rewind(time),
      save: ({ name }) => this.answer(this.saved(name)),
      tare: (message) => this.refuse(message),
      fly: (message) => this.refuse(message),
      turn: (message) => this.refuse(message),
      ping: () => undefined,
      pause: ({ on }) => (this.pacer.paused = on),
      speed: ({ factor }) => (this.pacer.speed = factor),
    };
  }

  /** Refuses what only a server has. */
  private refuse({ type }: PageMessage): never {
    throw new Refusal(this.manifest.page.texts.only_server, { what: type });
  }

  private ask(message: Message<"ask">): void {
    this.takingRequests(message.what).ask(message);
    const reason = message.what === "stop" ? "" : this.refusals()[message.what];
    if (reason) this.answer({ type: "refused", what: message.type, reason });
  }

  /** The hand, if the pilot takes requests. */
  private takingRequests(what: string): HandControl {
    const { no_requests: none } = this.manifest.page.texts;
    if (none) throw new Refusal(none, { what });
    return this.hand;
  }

  private reset(): void {
    this.begin(this.parameters.withWholeRotors());
    this.answer({ type: "scene", ...this.scene });
  }

  /** Flies again to a time with what was pushed and changed until then, and stands still there. */
  private rewind(time: number): void {
    const { flight: past, parameters } = this;
    const steps = Math.min(Math.round(time / this.module.manifest.dt) + 1, past.step);
    this.pacer.paused = true;
    this.begin(this.start);
    const hands = new Map(past.recorded.map(({ step, hand }) => [step, hand]));
    while (this.flight.step < steps) {
      this.parameters.repeat(this.flight, parameters.changes);
      const hand = hands.get(this.flight.step);
      if (hand) this.flight.hold(hand);
      this.advance();
    }
    this.hand.open();
    this.answer({ type: "scene", ...this.scene });
  }

  private refusals(): StatusRefusals {
    const { module, manifest, flight } = this;
    const { refused_at_end: ended } = manifest.page.texts;
    if (this.failed) return ended.error;
    if (flight.lost) return ended.stopped_early;
    return flight.over ? ended.over : refusalsNow(module, manifest.page, flight);
  }

  private begin(start: MissionNumbers): void {
    this.module.free();
    this.flight = new Flight(this.module, this.manifest.page, start.numbers);
    this.parameters = new ParameterControl(this.manifest, start);
    this.start = start;
    this.hand = new HandControl(this.flight, this.module, this.manifest.page);
    this.failed = false;
    this.run = this.newRun();
    this.advance();
  }

  private newRun(): CorridorRun | null {
    const { challenge, scene } = this.manifest.page;
    if (!scene.corridor || !challenge.columns.contact_force) return null;
    return new CorridorRun(scene.corridor, challenge, challenge.every * this.module.manifest.dt);
  }

  private advance(): void {
    const { step, time } = this.flight;
    this.flight.advance();
    if (step % this.manifest.page.challenge.every === 0) this.run?.add(time, this.flight.sample);
  }

  private saved(name: string): SavedFile {
    const bytes = recordedFlight(name, this.flight, this.manifest.page, this.start.tables, this.parameters.changes);
    return { type: "saved", name: `${name}.zip`, bytes };
  }

  private phase(ending: SceneEnding | null): Phase {
    if (this.failed) return "failed";
    if (ending) return ending.outcome;
    return this.flight.over ? "over" : this.manifest.page.scene.phases[this.value("phase")[0]];
  }

  /** The values of a field of the latest sample; empty if the mission does not have it. */
  private value(field: string): number[] {
    let found: number[] = [];
    this.eachValue((name, values) => {
      if (name === field) found = [...values];
    });
    return found;
  }

  private eachValue(use: (field: FlightScene["fields"][number][0], values: Float64Array) => void): void {
    const at = (this.flight.step - 1) * this.module.manifest.dt;
    const values = this.module.values("frame", [...this.flight.sample, at, ...this.manifest.page.phase_times]);
    let from = 0;
    for (const [field, count] of this.manifest.page.frame) {
      use(field as FlightScene["fields"][number][0], values.subarray(from, from + count));
      from += count;
    }
  }
}
