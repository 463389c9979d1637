// The delay from a person's event to a picture that shows its effect.

const KEPT = 60;
const STALE = 2000; // ms: a message that has not come back by then was dropped

/** Notes when messages were sent, by their number; median of the last delays. */
export class Latency {
  private sent: { seq: number; at: number }[] = [];
  private delays: number[] = [];

  /** A message was sent for an event at `at` [ms]; an impossible time of an event is replaced by `now`. */
  note(seq: number, at: number, now: number): void {
    this.sent.push({ seq, at: at <= now && now - at < STALE ? at : now });
  }

  /** A picture of the frame that echoes `seq` was drawn at `now`. */
  drawn(seq: number, now: number): void {
    const shown = this.sent.find((message) => message.seq === seq);
    if (shown) this.delays.push(now - shown.at);
    this.sent = this.sent.filter((message) => message.seq > seq && now - message.at < STALE);
    if (this.delays.length > KEPT) this.delays = this.delays.slice(-KEPT);
  }

  /** Median delay [ms]; null before anything was measured. */
  get median(): number | null {
    if (!this.delays.length) return null;
    const sorted = [...this.delays].sort((a, b) => a - b);
    return sorted[sorted.length >> 1];
  }
}
