// Turns of several pages at one flight: who has the hand, who waits, and the button that asks for it or gives it on.

import type { PageMessage, StatusMessage, TurnStatus } from "../wire/messages.generated.ts";
import { button, el } from "./dom.ts";

export class Turns {
  private readonly text = el("span", { role: "status" });
  private readonly button: HTMLButtonElement;
  private asks = true;
  readonly element: HTMLElement;

  constructor(send: (message: PageMessage) => void) {
    this.button = button("hand", "", "One page at a time has the hand; the others watch", () => {
      send({ type: "turn", what: this.asks ? "ask" : "give" });
    });
    this.element = el("div", { class: "strip turns", hidden: true }, this.text, this.button);
  }

  status({ viewers, turns }: StatusMessage): void {
    this.element.hidden = !turns || (viewers < 2 && turns.queue.length === 0);
    if (!turns) return;
    const { text, act } = turnTexts(turns);
    this.asks = !turns.queue.includes(turns.number);
    if (this.text.textContent !== text) this.text.textContent = text;
    const label = this.button.querySelector("span")!;
    if (label.textContent !== act) label.textContent = act;
  }
}

/** What a page says about the turns, and what its button does. */
export function turnTexts({ number, queue }: TurnStatus): { text: string; act: string } {
  const [first, ...waiting] = queue;
  const place = queue.indexOf(number);
  const you = `You are ${number}.`;
  if (!queue.length) return { text: `${you} Nobody has the hand.`, act: "Ask for the hand" };
  const rest = waiting.length ? ` Waiting: ${waiting.join(", ")}.` : "";
  if (place === 0) return { text: `${you} You have the hand.${rest}`, act: waiting.length ? "Give it on" : "Give it back" };
  return { text: `${you} ${first} has the hand.${rest}`, act: place < 0 ? "Ask for the hand" : "Leave the queue" };
}
