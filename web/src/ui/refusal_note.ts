// Above the buttons: why one would be refused, while a person points at it, and after it was pressed all the same.

import type { StatusMessage } from "../wire/messages.generated.ts";
import { el } from "./dom.ts";

const SHOWN_FOR = 10_000; // ms after a request, at most

type Request = "lift" | "land";

export class RefusalNote {
  private readonly text = el("p", { id: "refusal", hidden: true });
  readonly element = el("div", { class: "refusal-row" }, this.text);
  private refusals: Record<Request, string> = { lift: "", land: "" };
  private pointed: Request | null = null;
  private asked: Request = "lift";
  private until = 0; // ms

  constructor() {
    this.text.addEventListener("click", () => {
      this.until = 0;
      this.show("", false);
    });
  }

  /** Says why a request would be refused while a mouse, or the focus of keys, is at its button. */
  listen(element: HTMLElement, what: Request): void {
    const point = (at: boolean): void => {
      this.pointed = at ? what : null;
      this.update();
    };
    // a finger that has tapped would stay there: its press says the reason
    element.addEventListener("pointerenter", ({ pointerType }) => point(pointerType === "mouse"));
    element.addEventListener("focus", () => point(element.matches(":focus-visible")));
    for (const name of ["pointerleave", "blur"]) element.addEventListener(name, () => point(false));
  }

  /** A person has asked; a refusal may follow. */
  ask(what: Request): void {
    [this.asked, this.until] = [what, 0];
    this.show("", false);
  }

  refused(reason: string): void {
    this.until = performance.now() + SHOWN_FOR;
    this.show(reason, true);
  }

  /** Takes the reasons as they are now; one that was asked for leaves room for what is said at a hand. */
  status({ refusals, holder }: StatusMessage): void {
    this.refusals = refusals;
    if (holder === "you") this.until = 0;
    this.update();
  }

  private update(): void {
    const asked = performance.now() < this.until ? this.refusals[this.asked] : "";
    this.show(asked || (this.pointed ? this.refusals[this.pointed] : ""), asked !== "");
  }

  private show(text: string, asked: boolean): void {
    const { classList } = this.text;
    if (this.text.textContent !== text) this.text.textContent = text;
    this.text.hidden = text === "";
    if (classList.contains("asked") === asked) return;
    classList.toggle("asked", asked);
    this.text.role = asked ? "alert" : null;
  }
}
