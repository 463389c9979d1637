// The hand that pulls the vehicle, and the requests of the person. As `live.session.hand_control` does it.

import { scale } from "../math/vectors.ts";
import type { PageMessage, Vector } from "../wire/messages.generated.ts";
import type { Flight } from "./flight.ts";
import type { PageManifest } from "./manifest.ts";
import type { FlightModule } from "./module.ts";
import { Refusal, shown } from "./refusal.ts";

export type Message<T extends PageMessage["type"]> = Extract<PageMessage, { type: T }>;

const ZERO: Vector = [0, 0, 0];

export class HandControl {
  seq = 0;
  private offset: Vector = ZERO; // m, added to targets
  private moving: Message<"force"> | null = null; // the shake or tap in progress
  private since = 0; // the step at which it began
  private readonly requests = new Map<string, number>(); // until which step each is held

  constructor(
    private readonly flight: Flight,
    private readonly module: FlightModule,
    private readonly page: PageManifest,
  ) {}

  /** Takes hold at a point or at the centre of mass; `attitude`: of the vehicle. */
  grab({ point, target, at }: Message<"grab">, attitude: ArrayLike<number>): void {
    this.checkTouch(point);
    const centre = at === "centre";
    this.offset = centre ? vector(this.module.values("grip_offset", [...Array.from(attitude), ...point])) : ZERO;
    this.change({ held: [1], grip: centre ? ZERO : point, target: this.moved(target) });
  }

  move({ target }: Message<"move">): void {
    if (this.holds) this.change({ target: this.moved(target) });
  }

  push(message: Message<"force">): void {
    const { force, point, frequency = 0, duration = 0 } = message;
    const any = force.some((part) => part !== 0);
    if (any) this.checkTouch(point);
    if (!this.moving || !frequency || this.moving.frequency !== frequency) this.since = this.flight.step;
    this.moving = any && (frequency || duration) ? message : null;
    this.change({ force: this.moving ? ZERO : force, ...(any && !this.holds ? { grip: point } : {}) });
  }

  release(): void {
    this.moving = null;
    this.change({ held: [0], force: ZERO });
  }

  /** Releases, and withdraws all requests that can be withdrawn. */
  open(): void {
    this.change({ held: [0], force: ZERO, lift: [0], land: [0] });
  }

  ask({ what }: Message<"ask">): void {
    this.change({ [what]: [1] });
    const { dt } = this.module.manifest;
    if (what !== "stop") this.requests.set(what, this.flight.step + Math.round(this.page.request_time / dt));
  }

  enable(on: boolean): void {
    this.change({ enabled: [Number(on)] });
  }

  /** Withdraws the requests that have been held for long enough; before every step. */
  expireRequests(): void {
    const over = [...this.requests].filter(([, until]) => this.flight.step >= until).map(([what]) => what);
    for (const what of over) this.requests.delete(what);
    if (over.length) this.change(Object.fromEntries(over.map((what) => [what, [0]])));
    if (this.moving) this.goOn(this.moving);
  }

  private goOn({ force, frequency = 0, duration: once = 0 }: Message<"force">): void {
    const duration = once || 0.5 / frequency;
    const pulses = ((this.flight.step - this.since + 0.5) * this.module.manifest.dt) / duration;
    const n = Math.floor(pulses);
    if (once && n > 0) this.moving = null;
    const { lag } = this.page.tables["person"] as { lag: number };
    const now = this.moving ? pulse(pulses - n, lag / duration) : 0;
    this.change({ force: scale(force, n % 2 === 0 ? now : -now) });
  }

  get holds(): boolean {
    return this.part("held")[0] !== 0;
  }

  get pushes(): boolean {
    return this.moving !== null || this.part("force").some((value) => value !== 0);
  }

  /** A part of the hand's numbers. */
  part(name: string): Float64Array {
    const [at, size] = this.page.hand[name];
    return this.flight.hand.subarray(at, at + size);
  }

  /** The time for which nobody may touch the vehicle, as its force sensors are tared [s]; else 0. */
  get tareLeft(): number {
    const [, duration, end] = this.page.touch_rule;
    return Math.max(end - this.flight.time, duration - this.hovered, 0);
  }

  /** For how long the vehicle has hovered [s]; 0 where no tare needs it. */
  private get hovered(): number {
    return this.page.hover_time < 0 ? 0 : this.flight.number(this.page.hover_time);
  }

  private checkTouch(point: Vector): void {
    const { flight, page, hovered } = this;
    const [refusal] = this.module.values("touch_refusal", [...page.touch_rule, flight.time, hovered, ...point]);
    const text = page.texts.touch[String(refusal)];
    if (text) throw new Refusal(text, { point: shown(point) });
  }

  private moved(target: Vector): Vector {
    return [target[0] + this.offset[0], target[1] + this.offset[1], target[2] + this.offset[2]];
  }

  private change(parts: Record<string, readonly number[]>): void {
    const hand = this.flight.hand.slice();
    for (const [name, values] of Object.entries(parts)) hand.set(values, this.page.hand[name][0]);
    this.flight.hold(hand);
  }
}

/** What the hand's low-pass turns into a pulse; `lag`: in durations of it. */
function pulse(s: number, lag: number): number {
  const [r, slope] = [s * (1 - s), 1 - 2 * s];
  return 16 * r * r + 64 * lag * r * slope + 32 * lag * lag * (slope * slope - 2 * r);
}

function vector(values: Float64Array): Vector {
  return [values[0], values[1], values[2]];
}
