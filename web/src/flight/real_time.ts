// Flies a session by the clock, sends its frames and its status, and takes messages in between.

import type { PageMessage } from "../wire/messages.generated.ts";
import type { PageManifest } from "./manifest.ts";
import type { FromWorker } from "./protocol.ts";
import { Refusal } from "./refusal.ts";
import type { Session } from "./session.ts";

type Post = (message: FromWorker, moved?: Transferable[]) => void;

export class RealTimeLoop {
  private readonly again = new MessageChannel(); // a timer would wait 4 ms
  private frames = 0;
  private nextFrame = 0; // s
  private lastMessage = 0; // s
  private movedAt: number | null = null; // s: a move whose effect is still to be shown

  constructor(
    private readonly session: Session,
    private readonly page: PageManifest,
    private readonly clock: () => number, // s
    private readonly post: Post,
  ) {
    this.again.port1.onmessage = this.turn;
  }

  start(): void {
    this.nextFrame = this.clock();
    this.session.pacer.due(); // time begins now
    this.turn();
  }

  receive(message: PageMessage, seq: number): void {
    this.lastMessage = this.clock();
    try {
      this.session.apply(message, seq);
      if (message.type === "move") this.movedAt ??= this.lastMessage;
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      const subject = "key" in message && message.key ? `${message.type} ${message.key}` : message.type;
      this.post({ type: "refused", what: subject, reason: error.message });
    }
  }

  private readonly turn = (): void => {
    const { batch, pause } = this.page.pacing;
    const due = Math.min(this.session.pacer.due(), batch);
    const flown = this.session.fly(due);
    this.session.pacer.flew(flown);
    this.show(this.clock());
    if (flown < batch) setTimeout(this.turn, 1000 * pause);
    else this.again.port2.postMessage(null);
  };

  private show(now: number): void {
    const { echo, fresh, silent, status_every: every } = this.page.pacing;
    const echoes = this.movedAt !== null && now - this.movedAt >= echo;
    if (echoes) this.nextFrame = Math.max(this.nextFrame, now + fresh);
    else if (now < this.nextFrame) return;
    const values = this.session.frame();
    this.post({ type: "frame", values }, [values.buffer]);
    if (echoes) {
      this.movedAt = null;
      return;
    }
    if (this.frames % every === 0) this.post(this.session.status());
    this.frames += 1;
    this.nextFrame = Math.max(this.nextFrame + 1 / this.page.scene.rate, now - 1 / this.page.scene.rate);
    if (this.session.held && now - this.lastMessage > silent) this.session.release(); // the page hangs
  }
}
