// One flight, a step at a time, with ramps of its numbers and the hand recorded. As `simulation.stepping` does it.

import type { PageManifest } from "./manifest.ts";
import type { FlightModule, Numbers, Steps } from "./module.ts";
import { Refusal } from "./refusal.ts";

interface Ramp extends Steps {
  before: Numbers;
  after: Numbers;
  active: Numbers;
}

/** The hand from a step on. */
export interface HandEntry {
  step: number;
  hand: Float64Array;
}

export class Flight {
  step = 0;
  readonly recorded: HandEntry[] = [];
  private readonly numbers: Numbers; // of the mission as it is now
  private readonly trial: Numbers; // of the mission as it would be
  private prepared: Numbers;
  private spare: Numbers;
  private readonly flight: Numbers;
  private readonly context: Numbers;
  private readonly sampled: Numbers;
  private readonly at: Record<string, number>;
  private ramps: Ramp[] = [];
  private idle: Ramp[] = [];

  constructor(
    private readonly module: FlightModule,
    private readonly page: PageManifest,
    now: readonly number[],
  ) {
    const { sizes, numbers, context } = module.manifest;
    [this.numbers, this.trial] = [module.allocate(numbers.length), module.allocate(numbers.length)];
    [this.prepared, this.spare] = [module.allocate(sizes.prepared), module.allocate(sizes.prepared)];
    [this.flight, this.sampled] = [module.allocate(sizes.flight), module.allocate(sizes.sample)];
    this.context = module.allocate(context.words.length);
    this.at = Object.fromEntries(context.words.map((name, i) => [name, i]));
    this.begin(now);
  }

  get sample(): Float64Array {
    return this.module.view(this.sampled);
  }

  get time(): number {
    return this.step * this.module.manifest.dt;
  }

  get lost(): boolean {
    return this.number(this.page.lost) !== 0;
  }

  get over(): boolean {
    return this.step >= this.module.manifest.steps || this.lost;
  }

  number(index: number): number {
    return this.module.view(this.flight)[index];
  }

  numbersAt(at: number, size: number): Float64Array {
    return this.module.view(this.flight).subarray(at, at + size);
  }

  get hand(): Float64Array {
    const [at, size] = this.module.manifest.hand;
    return this.module.view(this.flight).subarray(at, at + size);
  }

  /** Moves the hand from the next step on. */
  hold(hand: Float64Array): void {
    this.hand.set(hand);
    this.put("fresh", 1);
    if (this.recorded.at(-1)?.step === this.step) this.recorded.pop();
    this.recorded.push({ step: this.step, hand: hand.slice() });
  }

  /** Takes a step. */
  advance(): void {
    const k = this.step;
    const changing = this.ramps.length > 0;
    this.ramps = this.ramps.filter((ramp) => this.goesOn(ramp, k));
    if (changing) this.put("fresh", 1);
    this.put("k", k);
    this.put("since", k);
    this.put("stop", k + 1);
    this.module.fly(this.context);
    this.put("fresh", 0);
    this.step += 1;
  }

  /** Goes to the numbers of a changed mission within a duration [s]; refuses what needs another flight. */
  change(now: readonly number[], key: string, differs: boolean, duration: number): void {
    const { module, page } = this;
    module.view(this.trial).set(now);
    if (module.prepare(this.trial, this.spare)) throw new Refusal(page.texts.other_laws, { key });
    if (this.touchesPlant()) throw new Refusal(page.texts.later, { key });
    const ramp = this.newRamp(Math.max(1, Math.round(duration / module.manifest.dt)));
    if (!module.view(ramp.active).includes(1) && differs) {
      this.idle.push(ramp);
      throw new Refusal(page.texts.no_effect, { key });
    }
    this.takeOver(ramp);
    [this.prepared, this.spare] = [this.spare, this.prepared];
    module.view(this.numbers).set(now);
  }

  private begin(now: readonly number[]): void {
    const { module } = this;
    module.view(this.numbers).set(now);
    const failed = module.prepare(this.numbers, this.prepared);
    if (failed) throw new Refusal(this.page.texts.other_laws, { key: failed.join(", ") });
    module.view(this.flight).set(this.flightOf(this.prepared));
    this.fillContext();
  }

  /** The flight's numbers of prepared ones. */
  private flightOf(prepared: Numbers): Float64Array {
    const [at] = this.module.manifest.prepared.flight;
    return this.module.view(prepared).subarray(at, at + this.flight.size);
  }

  private fillContext(): void {
    const { module } = this;
    const { sizes, delayed, delays, keys, dt } = module.manifest;
    const ring = module.allocate(sizes.ring_rows * sizes.ring_row);
    const [late, seeds] = [module.allocate(delays.length), module.allocate(keys.length)];
    const [work, last] = [module.allocate(sizes.work), module.allocate(sizes.sample)];
    const tables = module.allocate(this.prepared.size);
    module.view(tables).set(module.view(this.prepared));
    const row = delayed.flatMap(([at, size]) => [...module.view(this.flight).subarray(at, at + size)]);
    for (let i = 0; i < sizes.ring_rows; i++) module.view(ring).set(row, i * sizes.ring_row);
    delays.forEach((steps, i) => module.put(late, i, steps));
    module.view(seeds).set(keys);
    const places = { flight: this.flight, work, ring, delays: late, keys: seeds, log: this.sampled, last };
    for (const [name, { address }] of Object.entries(places)) this.put(name, address);
    for (const [name, count] of [["pushes", "push"], ["gusts", "gust"], ["walls", "wall"], ["legs", "leg"]] as const) {
      const { address, rows } = module.table(tables, name);
      this.put(name, address);
      this.put(`${count}_count`, rows);
    }
    this.put("rings", sizes.ring_rows);
    this.put("stride", sizes.sample);
    this.put("every", 1);
    this.put("fresh", 1);
    this.put("steps", -1); // the number of no step: none is the last
    module.view(this.context)[this.at["dt"]] = dt;
  }

  private put(word: string, value: number): void {
    this.module.put(this.context, this.at[word], value);
  }

  private goesOn(ramp: Ramp, k: number): boolean {
    const going = this.module.ramp(this.flight, ramp, k, ramp);
    if (!going) this.idle.push(ramp);
    return going;
  }

  /** Whether the tables or the body would change. */
  private touchesPlant(): boolean {
    const { module } = this;
    const [at, size] = this.page.plant;
    const [now, then] = [this.prepared, this.spare].map((one) => [
      ...module.tables(one),
      module.view(one).subarray(at, at + size),
    ]);
    return now.some((part, i) => part.some((value, k) => !Object.is(value, then[i][k])));
  }

  /** A ramp from the current numbers to the spare ones, of all numbers beyond the state that differ. */
  private newRamp(steps: number): Ramp {
    const { module } = this;
    const { flight, state } = module.manifest.sizes;
    const fresh = (): Numbers => module.allocate(flight);
    const ramp = this.idle.pop() ?? { before: fresh(), after: fresh(), active: fresh(), begin: 0, steps: 0 };
    [ramp.begin, ramp.steps] = [this.step, steps];
    module.view(ramp.before).set(module.view(this.flight));
    module.view(ramp.after).set(this.flightOf(this.spare));
    const [now, then, active] = [this.flightOf(this.prepared), module.view(ramp.after), module.view(ramp.active)];
    active.forEach((_, i) => (active[i] = i >= state && now[i] !== then[i] ? 1 : 0));
    return ramp;
  }

  /** Lets a ramp begin; it takes its numbers over from those that go on. */
  private takeOver(ramp: Ramp): void {
    const taken = this.module.view(ramp.active);
    for (const { active } of this.ramps) {
      const marks = this.module.view(active);
      marks.forEach((_, i) => (marks[i] = taken[i] ? 0 : marks[i]));
    }
    this.ramps.push(ramp);
  }
}
