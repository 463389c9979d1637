// Above the buttons: why those are grey that would be refused; set off once a person has asked all the same.

import type { StatusMessage } from "../wire/messages.generated.ts";
import { el } from "./dom.ts";

const SHOWN_FOR = 10_000; // ms after a request, at most

type Request = "lift" | "land";

export class RefusalNote {
  private readonly text = el("p", { id: "refusal", hidden: true });
  readonly element = el("div", { class: "refusal-row" }, this.text);
  private asked: Request = "lift";
  private until = 0; // ms
  private dismissed = "";

  constructor() {
    this.text.addEventListener("click", () => {
      this.dismissed = this.text.textContent;
      this.show("", false);
      this.until = 0;
    });
  }

  /** A person has asked; a refusal may follow. */
  ask(what: Request): void {
    [this.asked, this.until, this.dismissed] = [what, 0, ""];
    this.show("", false);
  }

  refused(reason: string): void {
    this.until = performance.now() + SHOWN_FOR;
    this.show(reason, true);
  }

  /** Shows the reasons as they are now; one that keeps a vehicle on the ground as if a person had asked. */
  status({ refusals, phase }: StatusMessage): void {
    const asked = performance.now() < this.until ? refusals[this.asked] : "";
    const reason = asked || (phase === "idle" ? refusals.lift : "");
    this.show(reason || greyFor(refusals.lift, refusals.land), reason !== "");
  }

  private show(text: string, asked: boolean): void {
    const { classList } = this.text;
    if (this.text.textContent !== text) this.text.textContent = text;
    this.text.hidden = text === "" || text === this.dismissed;
    if (classList.contains("asked") === asked) return;
    classList.toggle("asked", asked);
    this.text.role = asked ? "alert" : null;
  }
}

/** Why buttons are grey: a reason that both have, once. */
export function greyFor(lift: string, land: string): string {
  const reason = (sentence: string): string => sentence.slice(sentence.indexOf(":"));
  if (reason(lift) === reason(land)) return lift;
  return [lift, land].filter((sentence) => sentence !== "").join(" ");
}
