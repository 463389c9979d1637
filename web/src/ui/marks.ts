// What happened when: phases, pushes, touches, settings and findings of a flight, for plots and timeline.

import { size } from "../math/vectors.ts";
import { touching } from "../view/contact.ts";
import type { Frame } from "../wire/frames.ts";
import type { StatusFinding } from "../wire/messages.generated.ts";

const LEAST_PUSH = 0.05; // N
const APART = 0.5; // s without a push or touch, before another one begins
const MOST = 400; // marks that are kept

export type MarkKind = "push" | "touch" | "setting" | "finding";

export interface Mark {
  kind: MarkKind;
  time: number; // s
  text: string;
}

/** A stretch of time with one phase, by its number. */
export interface PhaseStretch {
  from: number;
  to: number;
  phase: number;
}

/** A push or a touch that goes on, or has just ended. */
interface Lasting {
  mark: Mark;
  until: number; // s
}

export class Marks {
  all: Mark[] = [];
  phases: PhaseStretch[] = [];
  private readonly lasting: Partial<Record<MarkKind, Lasting>> = {};
  private strongest = 0; // N, of the push that goes on

  frame(frame: Frame): void {
    const time = frame.scalar("time");
    this.phase(time, frame.scalar("phase"));
    const push = size(frame.vector("push"));
    if (push > LEAST_PUSH) this.push(time, push);
    const part = frame.scalar("contact_part");
    if (part !== 0) this.goesOn("touch", time, touching(part));
  }

  setting(time: number, text: string): void {
    this.add({ kind: "setting", time, text });
  }

  /** All findings so far, which take the place of those told before; their words may have changed. */
  findings(findings: readonly StatusFinding[]): void {
    const same = ({ time, text }: Mark, one: StatusFinding): boolean => one.time === time && text.startsWith(`${one.kind}:`);
    this.all = this.all.filter((mark) => mark.kind !== "finding" || findings.some((one) => same(mark, one)));
    for (const one of findings) {
      const text = `${one.kind}: ${one.text}`;
      const told = this.all.find((mark) => mark.kind === "finding" && same(mark, one));
      if (told) told.text = text;
      else this.add({ kind: "finding", time: one.time, text });
    }
  }

  /** What came after a time is no more. */
  cut(time: number): void {
    this.all = this.all.filter((one) => one.time < time);
    this.phases = this.phases.filter(({ from }) => from < time);
    const last = this.phases.at(-1);
    if (last) last.to = Math.min(last.to, time);
    delete this.lasting.push;
    delete this.lasting.touch;
  }

  private phase(time: number, phase: number): void {
    const last = this.phases.at(-1);
    if (last) last.to = time;
    if (last?.phase !== phase) this.phases.push({ from: time, to: time, phase });
  }

  private push(time: number, force: number): void {
    const lasting = this.goesOn("push", time, "");
    this.strongest = lasting.mark.time === time ? force : Math.max(this.strongest, force);
    const seconds = (time - lasting.mark.time).toFixed(1);
    lasting.mark.text = `push of ${this.strongest.toFixed(1)} N at most, for ${seconds} s`;
  }

  /** A push or a touch begins, or is that of a moment ago. */
  private goesOn(kind: MarkKind, time: number, text: string): Lasting {
    let lasting = this.lasting[kind];
    if (!lasting || time > lasting.until + APART) {
      lasting = { mark: { kind, time, text }, until: time };
      this.add(lasting.mark);
    }
    lasting.until = time;
    this.lasting[kind] = lasting;
    return lasting;
  }

  private add(mark: Mark): void {
    this.all.push(mark);
    if (this.all.length > MOST) this.all.shift();
  }
}
