// Pictures as the browser is ready for them, and few of them while nobody does anything and nothing moves.

import type { Frame } from "../wire/frames.ts";

const REST = 500; // ms between pictures at rest
const AWAKE = 2000; // ms after a person's last event, in which there is no rest
const EVENTS = ["pointerdown", "pointermove", "wheel", "keydown", "resize", "hashchange"] as const;
const UNSEEN = 0.004; // m and rad, all together

export class Rest {
  private timer = 0;
  private touched = 0; // ms, of a person's last event

  constructor(private readonly tick: FrameRequestCallback) {}

  start(): void {
    requestAnimationFrame(this.tick);
    for (const kind of EVENTS) {
      window.addEventListener(kind, () => {
        this.touched = performance.now();
        this.wake();
      });
    }
  }

  /** Asks for the next picture: of a page that rests, later. */
  next(resting: boolean): void {
    if (resting) this.timer = window.setTimeout(this.wake, REST);
    else requestAnimationFrame(this.tick);
  }

  /** A new frame has come: ends a rest if it would look another way. */
  look(drawn: Frame | null, frame: Frame, light: boolean): void {
    if (this.timer && !this.suits(drawn, frame, light)) this.wake();
  }

  /** Whether a frame looks like the one that was drawn; a graphics card goes on to show rotors that turn. */
  suits(drawn: Frame | null, frame: Frame, light: boolean): boolean {
    if (!drawn || performance.now() - this.touched < AWAKE) return false;
    return frame.scalar("time") === drawn.scalar("time") || (light && isStill(frame, drawn));
  }

  private readonly wake = (): void => {
    if (!this.timer) return;
    window.clearTimeout(this.timer);
    this.timer = 0;
    requestAnimationFrame(this.tick);
  };
}

/** Whether a vehicle that nobody pushes stands where it stood, to the eye. */
export function isStill(now: Frame, before: Frame): boolean {
  const apart = (name: "position" | "reference"): number => {
    const from = before.vector(name);
    return Math.hypot(...now.vector(name).map((value, i) => value - from[i]));
  };
  const turned = Math.hypot(...now.attitude.map((value, i) => value - before.attitude[i]));
  const same = (["phase", "alarm", "contact_part"] as const).every((name) => now.scalar(name) === before.scalar(name));
  const free = now.scalar("held") === 0 && Math.hypot(...now.vector("push")) === 0 && !now.ghost;
  return free && same && apart("position") + apart("reference") + turned < UNSEEN;
}
