// Over the picture: how the flight ended, and the way to begin again.

import type { Phase, StatusMessage } from "../wire/messages.generated.ts";
import { byId, el } from "./dom.ts";

const TITLES: Partial<Record<Phase, string>> = {
  crashed: "The vehicle has crashed",
  diverged: "The vehicle is out of control",
  over: "The flight is over",
  failed: "The flight has ended by an error",
};
const OTHERWISE: Partial<Record<Phase, string>> = {
  over: "No flight lasts longer.",
  failed: "The terminal, or the browser's console, says which.",
};

export class EndedCard {
  private readonly place = byId("ended");
  private readonly title = el("b");
  private readonly text = el("span");

  constructor(reset: () => void) {
    const again = el("button", { type: "button", class: "go" }, "Begin again");
    again.addEventListener("click", reset);
    this.place.replaceChildren(this.title, this.text, again);
  }

  status({ phase, ending, preparing }: StatusMessage): void {
    const title = preparing ? "" : (TITLES[phase] ?? "");
    this.place.hidden = title === "";
    if (this.title.textContent !== title) this.title.textContent = title;
    const text = ending?.text ?? OTHERWISE[phase] ?? "";
    if (this.text.textContent !== text) this.text.textContent = text;
  }
}
