// Beside the buttons: why a request is refused, and what to do, for as long as that holds.

import type { StatusRefusals } from "../wire/messages.generated.ts";
import { el } from "./dom.ts";

const SHOWN_FOR = 10_000; // ms after a request, at most

type Request = "lift" | "land";

export class RefusalNote {
  private readonly text = el("p", { id: "refusal", role: "alert", hidden: true });
  readonly element = el("div", { class: "refusal-row" }, this.text);
  private asked: Request = "lift";
  private until = 0; // ms

  constructor() {
    this.text.addEventListener("click", () => {
      this.show("");
      this.until = 0;
    });
  }

  /** A person has asked; a refusal may follow. */
  ask(what: Request): void {
    [this.asked, this.until] = [what, 0];
    this.show("");
  }

  refused(reason: string): void {
    this.until = performance.now() + SHOWN_FOR;
    this.show(reason);
  }

  /** Keeps the reason as it is now; `standing`: what to say even if nobody has asked. */
  status(refusals: StatusRefusals, standing: string): void {
    const reason = performance.now() < this.until ? refusals[this.asked] : "";
    this.show(reason || standing);
  }

  private show(reason: string): void {
    if (this.text.textContent !== reason) this.text.textContent = reason;
    this.text.hidden = reason === "";
  }
}
