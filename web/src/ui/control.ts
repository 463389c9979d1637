// One setting in the panel: sliders and numbers per axis, a choice, or a switch; with the way back to the mission's.

import type { Control, Setting } from "../wire/protocol.ts";
import { el, icon } from "./dom.ts";
import { Slide, short } from "./numbers.ts";

const AXES: Partial<Record<number, string[]>> = {
  3: ["x", "y", "z"],
  4: ["x", "y", "z", "yaw"],
  6: ["x", "y", "z", "roll", "pitch", "yaw"],
};

const PATIENCE = 2000; // ms, for which an answer to a wish is waited for

export interface Ask {
  set(key: string, value: Setting): void;
  restore(key: string): void;
}

/** A field of a control: what it shows is put in, what a person enters comes out. */
interface Field {
  row: HTMLElement;
  show(value: number | string | boolean): void;
}

export class ControlBox {
  readonly element: HTMLElement;
  private value: Setting;
  private asked: Setting | null = null; // on its way to the server
  private askedAt = 0; // ms
  private readonly initial: Setting;
  private readonly fields: Field[];
  private readonly reason = el("p", { class: "reason" });

  constructor(
    private readonly control: Control,
    private readonly ask: Ask,
  ) {
    this.value = control.value;
    this.initial = control.initial ?? control.value;
    const back = el("button", { type: "button", class: "back", title: "Back to the mission's value" }, icon("back"));
    back.addEventListener("click", () => {
      ask.restore(control.key);
    });
    const unit = el("small", {}, control.unit ?? "");
    const name = el("div", { class: "name", title: control.key }, el("span", {}, control.label), unit, back);
    this.fields = this.makeFields();
    const body = el("div", { class: "fields" }, ...this.fields.map(({ row }) => row));
    this.element = el("div", { class: "control", "data-key": control.key }, name, body, this.reason);
    this.show(control.value);
  }

  /** The server has set a value; it gets there within `duration` seconds. */
  changed(value: Setting, duration: number): void {
    // an answer to an earlier wish does not undo what was entered since
    const waiting = this.asked !== null && performance.now() - this.askedAt < PATIENCE;
    if (waiting && !same(this.asked!, value)) return;
    this.refuse("");
    this.show(value);
    this.element.classList.add("ramping");
    window.setTimeout(() => {
      this.element.classList.remove("ramping");
    }, 1000 * duration);
  }

  refuse(reason: string): void {
    this.asked = null;
    this.reason.textContent = reason;
    this.element.classList.toggle("refused", reason !== "");
    if (reason) this.show(this.value);
  }

  private show(value: Setting): void {
    this.value = value;
    const parts = [value].flat();
    this.fields.forEach((field, i) => {
      field.show(parts[i]);
    });
    this.element.classList.toggle("altered", !same(value, this.initial));
  }

  private makeFields(): Field[] {
    const { value, choices } = this.control;
    if (choices) return [this.chooser(choices)];
    if (typeof value === "boolean") return [this.switcher()];
    const parts = [value].flat() as number[];
    const names = this.control.axes ?? AXES[parts.length] ?? parts.map((_, i) => String(i + 1));
    return parts.map((_, i) => this.number(i, parts.length > 1 ? names[i] : ""));
  }

  private chooser(choices: (string | number | boolean)[]): Field {
    const options = choices.map((one) => el("option", { value: String(one) }, String(one)));
    const select = el("select", { "aria-label": this.control.label }, ...options);
    select.addEventListener("change", () => {
      this.ask.set(this.control.key, choices[select.selectedIndex]);
    });
    return { row: select, show: (value) => (select.value = String(value)) };
  }

  private switcher(): Field {
    const input = el("input", { type: "checkbox" });
    input.addEventListener("change", () => {
      this.ask.set(this.control.key, input.checked);
    });
    const row = el("label", { class: "toggle" }, input, el("span", {}, "on"));
    return { row, show: (value) => (input.checked = value === true) };
  }

  private number(i: number, axis: string): Field {
    const [low, high] = [bound(this.control.min, i), bound(this.control.max, i)];
    const name = `${this.control.label} ${axis}`.trim();
    const entry = el("input", { type: "number", step: "any", min: low, max: high, "aria-label": name });
    const enter = (value: number): void => {
      if (entry.value !== "" && Number.isFinite(value)) this.enter(i, value);
      else this.show(this.value);
    };
    entry.addEventListener("change", () => {
      enter(Number(entry.value));
    });
    const slide = low !== undefined && high !== undefined && high > low ? new Slide(low, high) : null;
    const bar = el("input", { type: "range", min: 0, max: 1000, "aria-label": `${name}, slider`, disabled: !slide });
    bar.addEventListener("input", () => (entry.value = short(slide!.value(bar.valueAsNumber))));
    bar.addEventListener("change", () => {
      enter(slide!.value(bar.valueAsNumber));
    });
    const row = el("div", { class: "number" }, el("span", { class: `axis ${axis}` }, axis), bar, entry);
    const show = (value: number | string | boolean): void => {
      entry.value = short(Number(value));
      bar.value = String(slide?.place(Number(value)) ?? 0);
    };
    return { row, show };
  }

  private enter(i: number, value: number): void {
    const now = this.asked ?? this.value;
    this.asked = Array.isArray(now) ? (now as number[]).map((v, k) => (k === i ? value : v)) : value;
    this.askedAt = performance.now();
    this.ask.set(this.control.key, this.asked);
  }
}

function same(a: Setting, b: Setting): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

function bound(limit: number | readonly number[] | undefined, i: number): number | undefined {
  return typeof limit === "object" ? limit[i] : limit;
}
