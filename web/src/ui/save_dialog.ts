// The dialog that asks for a name and saves the flight; it stays open until the server has saved, or says why not.

import { byId, el } from "./dom.ts";

export class SaveDialog {
  private readonly dialog = byId("saving") as HTMLDialogElement;
  private readonly name = el("input", { type: "text", id: "save-name", autocomplete: "off", spellcheck: "false" });
  private readonly reason = el("p", { class: "reason", role: "alert", id: "save-reason" });
  private readonly submit = el("button", { type: "submit", class: "go" }, "Save");

  constructor(private readonly save: (name: string) => number | null) {
    const cancel = el("button", { type: "button" }, "Cancel");
    cancel.addEventListener("click", () => this.dialog.close());
    const title = el("h2", { id: "saving-title" }, "Save the flight so far");
    const actions = el("div", { class: "actions" }, cancel, this.submit);
    const label = el("label", { for: "save-name" }, "Name");
    const form = el("form", {}, title, label, this.name, this.reason, actions);
    this.name.setAttribute("aria-describedby", "save-reason");
    this.name.addEventListener("input", () => this.show(""));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.show("", true);
      if (this.save(this.name.value) === null) this.refused("No flight is open now: nothing was saved.");
    });
    this.dialog.replaceChildren(form);
  }

  /** Opens with a name to begin with. */
  open(name: string): void {
    this.name.value = name;
    this.show("");
    this.dialog.showModal();
    this.name.select();
  }

  done(): void {
    this.dialog.close();
  }

  /** Shows why the flight was not saved; false if the dialog is closed. */
  refused(reason: string): boolean {
    if (!this.dialog.open) return false;
    this.show(reason);
    this.name.focus();
    return true;
  }

  private show(reason: string, waiting = false): void {
    this.reason.textContent = reason;
    this.name.setAttribute("aria-invalid", String(reason !== ""));
    this.submit.disabled = waiting;
    this.submit.textContent = waiting ? "Saving \u2026" : "Save";
  }
}
