// Why a pull or a push has no effect: what is said at the point where the hand is.

import type { HandView, Remark } from "../view/picture.ts";
import type { Frame } from "../wire/frames.ts";
import type { StatusMessage, Vector } from "../wire/messages.generated.ts";

const SHOWN_FOR = 5000; // ms, of a touch that was refused
const LASTING = 2; // statuses: what lasts shorter is not said
const CENTRE: Vector = [0, 0, 0];

export class Remarks {
  private text = "";
  private statuses = 0;
  private refused: (Remark & { until: number }) | null = null;

  /** A touch was refused, of a hand that the page shows so. */
  refuse(text: string, hand: HandView): void {
    const point = hand.kind === "none" ? CENTRE : hand.point;
    this.refused = { text, point, until: performance.now() + SHOWN_FOR };
  }

  status({ holder, refusals, ending }: StatusMessage): void {
    this.text = holder === "none" || ending ? "" : refusals.push;
    this.statuses = this.text ? this.statuses + 1 : 0;
  }

  /** What to say with a frame. */
  now(frame: Frame): Remark | null {
    if (this.refused && performance.now() < this.refused.until) return this.refused;
    if (this.statuses < LASTING) return null;
    const point = frame.vector(frame.scalar("held") > 0 ? "hand_point" : "push_point");
    return { text: this.text, point };
  }
}
