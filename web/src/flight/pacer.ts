// Real time: how many steps are due by the clock. As `live.session.pacing` does it.

import type { PacingConstants } from "./manifest.ts";

export class Pacer {
  speed = 1;
  paused = false;
  behind = 0; // s of flight that are due
  mostBehind = 0; // s, since this was last set to 0
  private then = 0;
  private flown: { at: number; steps: number }[] = [];

  constructor(
    private readonly dt: number,
    private readonly constants: PacingConstants,
    private readonly clock: () => number, // s
  ) {
    this.then = clock();
  }

  /** Steps to be flown now. */
  due(): number {
    const now = this.clock();
    const passed = now - this.then;
    this.then = now;
    if (this.paused) {
      this.behind = 0;
      return 0;
    }
    this.behind = Math.min(this.behind + passed * this.speed, this.constants.most_behind);
    this.mostBehind = Math.max(this.mostBehind, this.behind);
    return Math.floor(this.behind / this.dt);
  }

  flew(steps: number): void {
    this.behind -= steps * this.dt;
    const now = this.clock();
    this.flown.push({ at: now, steps });
    while (now - this.flown[0].at > this.constants.window) this.flown.shift();
  }

  /** Flight time over wall time, during the last second. */
  get factor(): number {
    if (this.flown.length < 2) return 0;
    const span = this.clock() - this.flown[0].at;
    const steps = this.flown.slice(1).reduce((sum, one) => sum + one.steps, 0);
    return (steps * this.dt) / Math.max(span, 1e-3);
  }
}
