// What went badly in the flight: a notice for each new finding.

import type { StatusFinding } from "../wire/messages.generated.ts";
import type { Notices } from "./notices.ts";

const AGAIN = 10; // s of the flight, before the same kind is told again

export class Findings {
  private readonly told = new Map<string, number>(); // kind: time of the last that was told

  constructor(private readonly notices: Notices) {}

  status(findings: readonly StatusFinding[]): void {
    if (findings.length === 0) this.told.clear(); // a new flight
    for (const { kind, time, text } of findings) {
      if (time < (this.told.get(kind) ?? -AGAIN) + AGAIN) continue; // the same one, whose text may have changed
      this.told.set(kind, time);
      this.notices.show(`${time.toFixed(1)} s, ${kind}: ${text}`, "finding");
    }
  }
}
