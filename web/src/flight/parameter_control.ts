// Changes of a flight: parameters set and restored, rotors stopped. As `live.session.parameters` does it.

import type { ChangedMessage, ParameterValue, RefusedMessage, SceneParameter } from "../wire/messages.generated.ts";
import type { Flight } from "./flight.ts";
import type { FlightManifest, TunableParameter } from "./manifest.ts";
import { MissionNumbers, type Value } from "./mission_numbers.ts";
import type { RecordedChange } from "./recording.ts";
import { Refusal, shown } from "./refusal.ts";

type Answer = ChangedMessage | RefusedMessage;

export class ParameterControl {
  now: MissionNumbers;
  readonly changes: RecordedChange[] = [];
  private readonly first: MissionNumbers;
  private readonly known: Map<string, TunableParameter>;

  constructor(
    private readonly manifest: FlightManifest,
    start: MissionNumbers,
  ) {
    this.first = new MissionNumbers(manifest);
    this.now = start;
    this.known = new Map(manifest.page.parameters.map((one) => [one.shown.key, one]));
  }

  /** The parameters as they are now. */
  get parameters(): SceneParameter[] {
    return this.manifest.page.parameters.map((one) => ({ ...one.shown, value: this.now.value(one.keys[0]) }));
  }

  set(flight: Flight, key: string, value: ParameterValue): Answer[] {
    const parameter = this.checked(key, value);
    return [this.setTo(flight, parameter, parameter.keys.map(() => value as Value))];
  }

  /** Sets a parameter, or all, back to the mission's own value. */
  restore(flight: Flight, key: string | undefined): Answer[] {
    const keys = key === undefined ? [...this.known.keys()] : [key];
    return keys.flatMap((one) => {
      try {
        return this.restoreOne(flight, one);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        return [{ type: "refused", what: `restore ${one}`, reason: error.message }];
      }
    });
  }

  stopRotor(flight: Flight, rotor: number): void {
    const { rotors, never, texts } = this.manifest.page;
    const key = rotors.find((one) => one.rotor === rotor)?.key;
    if (key === undefined) throw new Refusal(texts.whole_rotors, { rotor: rotor + 1 });
    const time = this.now.value(key) as number;
    if (time < never) throw new Refusal(texts.failed_already, { rotor: rotor + 1, time });
    this.change(flight, key, flight.time, 0);
  }

  /** Makes the changes that another flight of the same mission made at this flight's step. */
  repeat(flight: Flight, changes: readonly RecordedChange[]): void {
    for (const { time, key, value, duration } of changes) {
      if (time === flight.time) this.change(flight, key, value, duration);
    }
  }

  /** The rotors that have stopped. */
  failed(at: number): number[] {
    const stopped = this.manifest.page.rotors.filter(({ key }) => (this.now.value(key) as number) <= at);
    return stopped.map(({ rotor }) => rotor).sort((a, b) => a - b);
  }

  /** The mission as it is now, with the rotors of the first one: what a reset begins. */
  withWholeRotors(): MissionNumbers {
    const again = this.now.copy();
    for (const { key } of this.manifest.page.rotors) again.set(key, this.first.value(key));
    return again;
  }

  private checked(key: string, value: ParameterValue): TunableParameter {
    const { texts, absent } = this.manifest.page;
    const parameter = this.known.get(key);
    const said = { key, value: shown(value) };
    if (!parameter) throw new Refusal(absent[key] ?? texts.unknown, said);
    const { min, max } = parameter.shown;
    for (const number of [value].flat()) {
      if (typeof number !== "number") throw new Refusal(texts.no_number, said);
      if (!(number >= min && number <= max)) throw new Refusal(parameter.out_of_bounds, said);
    }
    if (Array.isArray(value) && value.length !== parameter.count) throw new Refusal(parameter.wrong_shape, said);
    if (!Array.isArray(value) && !parameter.alone && !(value === 0 && parameter.zero)) {
      throw new Refusal(parameter.wrong_shape + parameter.such_as, said);
    }
    return parameter;
  }

  private restoreOne(flight: Flight, key: string): Answer[] {
    const parameter = this.known.get(key);
    if (!parameter) return [];
    const values = parameter.keys.map((one) => this.first.value(one));
    if (parameter.keys.every((one, i) => !this.now.differs(one, values[i]))) return [];
    return [this.setTo(flight, parameter, values)];
  }

  private setTo(flight: Flight, { shown: { key }, keys }: TunableParameter, values: readonly Value[]): Answer {
    const duration = this.manifest.page.ramp;
    keys.forEach((one, i) => this.change(flight, one, values[i], duration));
    return { type: "changed", key, value: this.now.value(keys[0]), duration };
  }

  private change(flight: Flight, key: string, value: Value, duration: number): void {
    const { texts } = this.manifest.page;
    if (flight.over) throw new Refusal(texts.over, { key });
    const then = this.now.copy();
    if (!then.set(key, value)) throw new Refusal(texts.other_laws, { key });
    flight.change(then.numbers, key, this.now.differs(key, value), duration);
    this.changes.push({ time: flight.time, key, value, duration });
    this.now = then;
  }
}
