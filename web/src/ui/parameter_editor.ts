// One parameter in the panel: sliders and numbers per axis, a choice, or a switch; a button restores its value.

import { type PageMessage, type ParameterValue, type SceneParameter, THRESHOLD } from "../wire/messages.generated.ts";
import { same } from "../wire/parameters.ts";
import { el, icon, toggle } from "./dom.ts";
import { SliderScale, formatNumber } from "./numbers.ts";

const AXES: Partial<Record<number, string[]>> = {
  3: ["x", "y", "z"],
  4: ["x", "y", "z", "yaw"],
  6: ["x", "y", "z", "roll", "pitch", "yaw"],
};

const LOCKED: readonly string[] = ["admittance.mass", "admittance.damping", THRESHOLD]; // may be the same on x, y, z

const ALIKE = new Set<string>(); // of them, those that a person wants so; a reset keeps it

const ANSWER_WITHIN = 2000; // ms

/** An input of a parameter, and how it is given the value that it shows. */
interface Field {
  row: HTMLElement;
  show(value: number | string | boolean): void;
}

export class ParameterEditor {
  readonly element: HTMLElement;
  private value: ParameterValue;
  private asked: ParameterValue | null = null; // on its way to the server
  private askedAt = 0; // ms
  private readonly initial: ParameterValue;
  private readonly fields: Field[];
  private readonly reason = el("p", { class: "reason" });

  constructor(
    private readonly parameter: SceneParameter,
    private readonly send: (message: PageMessage) => void,
  ) {
    this.value = parameter.value;
    this.initial = parameter.initial ?? parameter.value;
    const back = el("button", { type: "button", class: "back", title: "Restore the mission's value" }, icon("back"));
    back.addEventListener("click", () => send({ type: "restore", key: parameter.key }));
    const unit = el("small", {}, parameter.unit ?? "");
    const name = el("div", { class: "name", title: parameter.key }, el("span", {}, parameter.label), unit);
    name.append(...(LOCKED.includes(parameter.key) ? [this.lock()] : []), back);
    this.fields = this.makeFields();
    const body = el("div", { class: "fields" }, ...this.fields.map(({ row }) => row));
    this.element = el("div", { class: "parameter", "data-key": parameter.key }, name, body, this.reason);
    this.show(parameter.value);
  }

  /** The value with which a flight begins; what is half written stays if it is the one that was shown. */
  begin(value: ParameterValue): void {
    const other = this.asked !== null || !same(this.value, value);
    this.refuse("");
    if (other) this.show(value);
  }

  /** The server has set a value; it gets there within `duration` seconds. */
  changed(value: ParameterValue, duration: number): void {
    // an answer to an earlier message does not undo what was entered since
    const waiting = this.asked !== null && performance.now() - this.askedAt < ANSWER_WITHIN;
    if (waiting && !same(this.asked!, value)) return;
    this.refuse("");
    this.show(value);
    this.element.classList.add("ramping");
    window.setTimeout(() => this.element.classList.remove("ramping"), 1000 * duration);
  }

  refuse(reason: string): void {
    this.asked = null;
    this.reason.textContent = reason;
    this.element.classList.toggle("refused", reason !== "");
    if (reason) this.show(this.value);
  }

  private show(value: ParameterValue): void {
    this.value = value;
    const parts = [value].flat();
    this.fields.forEach((field, i) => field.show(parts[i]));
    this.element.classList.toggle("altered", !same(value, this.initial));
  }

  private makeFields(): Field[] {
    const { value, choices } = this.parameter;
    if (choices) return [this.select(choices)];
    if (typeof value === "boolean") return [this.checkbox()];
    const parts = [value].flat() as number[];
    const names = AXES[parts.length] ?? parts.map((_, i) => String(i + 1));
    return parts.map((_, i) => this.number(i, parts.length > 1 ? names[i] : ""));
  }

  /** A switch that keeps x, y and z the same, from that of x on. */
  private lock(): HTMLElement {
    const { key } = this.parameter;
    return toggle("x = y = z", ALIKE.has(key), (on) => {
      if (on) ALIKE.add(key);
      else ALIKE.delete(key);
      const [x, ...others] = [this.value].flat() as number[];
      if (on && others.slice(0, 2).some((one) => one !== x)) this.enter(0, x);
    });
  }

  private select(choices: string[]): Field {
    const options = choices.map((one) => el("option", { value: one }, one));
    const select = el("select", { "aria-label": this.parameter.label }, ...options);
    select.addEventListener("change", () => this.set(choices[select.selectedIndex]));
    return { row: select, show: (value) => (select.value = String(value)) };
  }

  private checkbox(): Field {
    const input = el("input", { type: "checkbox" });
    input.addEventListener("change", () => this.set(input.checked));
    const row = el("label", { class: "toggle" }, input, el("span", {}, "on"));
    return { row, show: (value) => (input.checked = value === true) };
  }

  private number(i: number, axis: string): Field {
    const [low, high] = [this.parameter.min, this.parameter.max];
    const name = `${this.parameter.label} ${axis}`.trim();
    const entry = el("input", { type: "number", step: "any", min: low, max: high, "aria-label": name });
    const enter = (value: number): void => {
      if (entry.value !== "" && Number.isFinite(value)) this.enter(i, value);
      else this.refuse(`${name}: ${entry.value || "what was entered"} is no finite number`);
    };
    entry.addEventListener("change", () => enter(Number(entry.value)));
    const slide = low !== undefined && high !== undefined && high > low ? new SliderScale(low, high) : null;
    const bar = el("input", { type: "range", min: 0, max: 1000, "aria-label": `${name}, slider`, disabled: !slide });
    bar.addEventListener("input", () => (entry.value = formatNumber(slide!.value(bar.valueAsNumber))));
    bar.addEventListener("change", () => enter(slide!.value(bar.valueAsNumber)));
    const row = el("div", { class: "number" }, el("span", { class: `axis ${axis}` }, axis), bar, entry);
    const show = (value: number | string | boolean): void => {
      entry.defaultValue = entry.value = formatNumber(Number(value));
      bar.value = String(slide?.place(Number(value)) ?? 0);
    };
    return { row, show };
  }

  private set(value: ParameterValue): void {
    this.send({ type: "set", key: this.parameter.key, value });
  }

  private enter(i: number, value: number): void {
    const now = this.asked ?? this.value;
    const alike = ALIKE.has(this.parameter.key) && i < 3; // the fourth number is of the yaw
    const takes = (k: number): boolean => k === i || (alike && k < 3);
    this.asked = Array.isArray(now) ? (now as number[]).map((v, k) => (takes(k) ? value : v)) : value;
    this.askedAt = performance.now();
    this.set(this.asked);
  }
}
