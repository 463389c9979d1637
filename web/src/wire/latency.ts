// How long it takes from a hand's event until a picture shows what came of it.

const KEPT = 60;
const STALE = 2000; // ms: what has not come back by then was dropped on its way

/** Times of messages by their number, and the median of the last delays. */
export class Latency {
  private sent: { seq: number; at: number }[] = [];
  private delays: number[] = [];

  /** A message was sent for an event at `at` [ms]; clocks of events that cannot be right are not believed. */
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
