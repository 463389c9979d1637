// A saved flight that the page carries: the same scene and frames as from a server.

import { between, floats, Frame, Layout } from "./frames.ts";
import type { FlightScene, StatusMessage } from "./messages.generated.ts";
import type { FlightListener, FlightSource } from "./source.ts";

/** The status of what is not flown now, but for phase, ending and pace. */
export const NOT_LIVE = {
  type: "status",
  enabled: true,
  behind_ms: 0,
  recorded_s: 0,
  failed_rotors: [],
  tare_left_s: 0,
  refusals: { lift: "", land: "", push: "" },
  viewers: 1,
  holder: "none",
  last_grab: 0,
} as const;

export class Replay implements FlightSource {
  private listener: FlightListener | null = null;
  private readonly layout: Layout;
  private readonly values: Float32Array;
  private readonly timeAt: number;
  private readonly count: number;
  private time: number;
  private paused = false;
  private speed: number;
  private last = 0;

  constructor(
    private readonly scene: FlightScene,
    values: Float32Array,
  ) {
    this.layout = new Layout(scene.fields);
    this.values = values;
    this.timeAt = this.layout.place("time").start;
    this.count = Math.floor(values.length / this.layout.size);
    this.scene.replay ??= { start: this.timeOf(0), end: this.timeOf(this.count - 1), speed: 1, ending: null };
    this.time = this.scene.replay.start;
    this.speed = this.scene.replay.speed;
  }

  start(listener: FlightListener): void {
    this.listener = listener;
    listener.connected();
    listener.scene(this.scene);
    this.show();
  }

  /** A saved flight takes no messages. */
  send(): null {
    return null;
  }

  get playing(): boolean {
    return !this.paused;
  }

  play(on: boolean): void {
    const { start, end } = this.scene.replay!;
    this.paused = !on;
    if (on && this.time >= end) this.time = start;
    this.show();
  }

  seek(time: number): void {
    const { start, end } = this.scene.replay!;
    this.time = Math.min(Math.max(time, start), end);
    this.show();
  }

  setSpeed(factor: number): void {
    this.speed = factor;
  }

  tick(now: number): void {
    const passed = this.last ? Math.min((now - this.last) / 1000, 0.25) : 0;
    this.last = now;
    if (this.paused) return;
    this.time += passed * this.speed;
    if (this.time >= this.scene.replay!.end) {
      this.time = this.scene.replay!.end;
      this.paused = true;
    }
    this.show();
  }

  /** All frames, oldest first. */
  frames(): Frame[] {
    return Array.from({ length: this.count }, (_, i) => this.frameAt(i));
  }

  private show(): void {
    const i = Math.min(this.index(this.time), this.count - 2);
    const [a, b] = [this.frameAt(Math.max(i, 0)), this.frameAt(Math.min(i + 1, this.count - 1))];
    const width = b.scalar("time") - a.scalar("time");
    const fraction = width > 0 ? Math.min(Math.max((this.time - a.scalar("time")) / width, 0), 1) : 0;
    const frame = between(a, b, fraction);
    this.listener?.status(this.status(frame));
    this.listener?.frame(frame);
  }

  private status(frame: Frame): StatusMessage {
    const phase = this.scene.phases[frame.scalar("phase")] ?? "idle";
    const alarm = this.scene.alarms[frame.scalar("alarm")] ?? "";
    const { end, ending } = this.scene.replay!;
    const over = this.time >= end ? ending : null;
    const state = { phase: over?.outcome ?? phase, alarm, ending: over };
    return { ...NOT_LIVE, ...state, paused: this.paused, speed: this.speed, factor: this.speed };
  }

  private timeOf(i: number): number {
    return this.values[i * this.layout.size + this.timeAt];
  }

  private frameAt(i: number): Frame {
    return new Frame(this.layout, this.values.subarray(i * this.layout.size, (i + 1) * this.layout.size));
  }

  /** The last frame not after a time. */
  private index(time: number): number {
    let [low, high] = [0, this.count];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.timeOf(middle) <= time) low = middle;
      else high = middle;
    }
    return low;
  }
}

/** The flight that a self-contained page carries; null in a page that a server sent. */
export function embeddedReplay(): Replay | null {
  const text = document.getElementById("flight")?.textContent;
  if (!text) return null;
  const { scene, frames } = JSON.parse(text) as { scene: FlightScene; frames: string };
  return new Replay(scene, floats(bytes(frames)));
}

/** The bytes of a base64 text. */
export function bytes(text: string): ArrayBuffer {
  const raw = atob(text);
  return Uint8Array.from(raw, (character) => character.charCodeAt(0)).buffer;
}
