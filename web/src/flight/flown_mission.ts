// A mission as it is flown: its module, the flight, its changes, and its run through a corridor.

import { Layout } from "../wire/frames.ts";
import type { FlightScene, FrameFieldName } from "../wire/messages.generated.ts";
import { CorridorRun } from "./corridor_run.ts";
import { Flight } from "./flight.ts";
import type { FlightManifest } from "./manifest.ts";
import { MissionNumbers } from "./mission_numbers.ts";
import { FlightModule } from "./module.ts";
import { ParameterControl } from "./parameter_control.ts";
import { recordedFlight } from "./recording.ts";

const HAND = { held: "held", hand_point: "grip", hand_target: "target", push_point: "grip" } as const;

export class FlownMission {
  readonly module: FlightModule;
  flight!: Flight;
  parameters!: ParameterControl;
  run: CorridorRun | null = null;
  private start!: MissionNumbers;
  private readonly layout: Layout;

  constructor(
    private readonly code: WebAssembly.Module,
    readonly manifest: FlightManifest,
  ) {
    this.module = new FlightModule(code, manifest.module);
    this.layout = new Layout(manifest.page.scene.fields);
    this.begin(new MissionNumbers(manifest));
  }

  /** Begins again as it is now, with whole rotors. */
  again(): void {
    this.begin(this.parameters.withWholeRotors());
  }

  /** Flies anew what another flight of the mission, or itself, flew until a step at most. */
  refly(past: FlownMission, most: number): void {
    const { changes } = past.parameters;
    const hands = new Map(past.flight.recorded.map(({ step, hand }) => [step, hand]));
    const steps = Math.min(most, past.flight.step);
    this.begin(past.start);
    while (this.flight.step < steps) {
      this.parameters.repeat(this.flight, changes);
      const hand = hands.get(this.flight.step);
      if (hand) this.flight.hold(hand);
      this.advance();
    }
  }

  /** The same flight once more, which goes on apart from it. */
  twin(): FlownMission {
    const one = new FlownMission(this.code, this.manifest);
    one.refly(this, this.flight.step);
    return one;
  }

  advance(): void {
    const { step, time } = this.flight;
    this.flight.advance();
    if (step % this.manifest.page.challenge.every === 0) this.run?.add(time, this.flight.sample);
  }

  get scene(): FlightScene {
    const { now, parameters } = this.parameters;
    const number = (key: string): number => now.value(key) as number;
    const spring = {
      stiffness: number("person.stiffness"),
      damping: number("person.damping"),
      max_force: number("person.max_force"),
    };
    const threshold = now.value("admittance.threshold") as unknown as FlightScene["threshold"];
    return { ...this.manifest.page.scene, threshold, spring, parameters };
  }

  /** Writes the latest sample and the hand as a frame. */
  write(frame: Float32Array): void {
    this.eachValue((field, values) => frame.set(values, this.layout.place(field).start));
    for (const [field, part] of Object.entries(HAND)) {
      const [at, size] = this.manifest.page.hand[part];
      frame.set(this.flight.hand.subarray(at, at + size), this.layout.place(field as keyof typeof HAND).start);
    }
  }

  /** The values of a field of the latest sample; empty if the mission does not have it. */
  value(field: FrameFieldName): number[] {
    let found: number[] = [];
    this.eachValue((name, values) => {
      if (name === field) found = [...values];
    });
    return found;
  }

  /** The files of a flight that flies again. */
  saved(name: string): Uint8Array<ArrayBuffer> {
    const { flight, manifest, start, parameters, run } = this;
    return recordedFlight(name, flight, manifest.page, start.tables, parameters.changes, run?.score ?? null);
  }

  private begin(start: MissionNumbers): void {
    const { page } = this.manifest;
    this.module.free();
    this.flight = new Flight(this.module, page, start.numbers);
    this.flight.hold(Float64Array.from(page.released));
    this.parameters = new ParameterControl(this.manifest, start);
    this.start = start;
    this.run = this.newRun();
    this.advance();
  }

  private newRun(): CorridorRun | null {
    const { challenge, scene } = this.manifest.page;
    if (!scene.corridor || !challenge.columns.contact_force) return null;
    return new CorridorRun(scene.corridor, challenge, challenge.every * this.module.manifest.dt);
  }

  private eachValue(use: (field: FrameFieldName, values: Float64Array) => void): void {
    const at = (this.flight.step - 1) * this.module.manifest.dt;
    const values = this.module.values("frame", [...this.flight.sample, at, ...this.manifest.page.phase_times]);
    let from = 0;
    for (const [field, count] of this.manifest.page.frame) {
      use(field as FrameFieldName, values.subarray(from, from + count));
      from += count;
    }
  }
}
