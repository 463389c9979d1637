// A dialog that asks before something is done, or says why it was not.

import { byId, el } from "./dom.ts";

export class Question {
  private readonly dialog = byId("question") as HTMLDialogElement;
  private asking = false;

  /** Asks; `act` is called if the answer is `yes`. Escape and a press beside the dialog are Cancel. */
  ask(title: string, text: string, yes: string, act: () => void): void {
    const cancel = this.button("Cancel", "");
    this.show(title, text, cancel, this.button(yes, "alarm", act));
    this.asking = true;
    cancel.focus();
  }

  /** Says something until it is closed. */
  tell(title: string, text: string): void {
    this.show(title, text, this.button("Close", "go"));
  }

  /** Takes a question back that is no longer one. */
  withdraw(): void {
    if (this.asking) this.dialog.close();
  }

  private button(name: string, kind: string, act?: () => void): HTMLButtonElement {
    const one = el("button", { type: "button", class: kind }, name);
    one.addEventListener("click", () => {
      this.dialog.close();
      act?.();
    });
    return one;
  }

  private show(title: string, text: string, ...buttons: HTMLElement[]): void {
    const { dialog } = this;
    this.asking = false;
    dialog.onclick = (event) => {
      if (event.target === dialog) dialog.close();
    };
    const head = el("h2", { id: "question-title" }, title);
    dialog.replaceChildren(head, el("p", {}, text), el("div", { class: "actions" }, ...buttons));
    if (!dialog.open) dialog.showModal();
  }
}
