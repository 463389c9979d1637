// The panel: the hand, every parameter that the scene offers, the rotors, and what is drawn.

import type { HandOptions } from "../hand/options.ts";
import type { GraphicsChoice } from "../view/graphics.ts";
import {
  type FlightScene,
  MAX_FORCE,
  type PageMessage,
  type ParameterValue,
  type SceneParameter,
} from "../wire/messages.generated.ts";
import { choice, el, icon, showChosen } from "./dom.ts";
import { handRows, type LimitedForce, row } from "./hand_rows.ts";
import { ParameterEditor } from "./parameter_editor.ts";
import { RotorMap } from "./rotor_map.ts";
import type { ThemeChoice } from "./theme.ts";

/** What the panel needs of the page. */
export interface PanelPage {
  readonly hand: HandOptions;
  readonly extra: readonly HTMLElement[]; // at its end
  send(message: PageMessage): void;
  readonly theme: ThemeChoice;
  readonly graphicsChoice: GraphicsChoice;
  setGraphics(choice: GraphicsChoice): void;
  setTheme(choice: ThemeChoice): void;
}

export class Panel {
  private editors = new Map<string, ParameterEditor>();
  private rotors: RotorMap | null = null;
  private open: Record<string, boolean> = {};
  private built = ""; // what the parts are of, as JSON
  private force: LimitedForce | null = null;
  private planes: HTMLElement | null = null;
  private initial: { mission: string; values: Map<string, ParameterValue> } = { mission: "", values: new Map() };

  constructor(
    private readonly place: HTMLElement,
    private readonly page: PanelPage,
    private readonly undo: HTMLElement,
  ) {}

  /** Shows a flight; the parts stay, with what is half written in them, where they are the same. */
  scene(scene: FlightScene): void {
    const parameters = this.remembered(scene);
    const parts = JSON.stringify([scene.vehicle, parameters.map((one) => ({ ...one, value: null }))]);
    if (parts !== this.built) this.build(scene, parameters);
    this.built = parts;
    for (const { key, value } of parameters) this.editors.get(key)!.begin(value);
    this.force?.limit(scene.spring.max_force);
  }

  private build(scene: FlightScene, parameters: SceneParameter[]): void {
    for (const one of this.place.querySelectorAll("details")) this.open[one.dataset["name"] ?? ""] = one.open;
    const live = !scene.replay;
    const send = this.page.send.bind(this.page);
    this.editors = new Map(parameters.map((one) => [one.key, new ParameterEditor(one, send)]));
    this.rotors = live ? new RotorMap(scene, send) : null;
    const names = [...new Set(scene.parameters.map(({ group }) => group))];
    const groups = names.map((name) => {
      const keys = scene.parameters.filter(({ group }) => group === name).map(({ key }) => key);
      return this.group(
        name,
        keys.map((key) => this.editors.get(key)!.element),
      );
    });
    this.place.replaceChildren(
      ...(live ? [this.group("hand", this.hand(), true)] : []),
      ...groups,
      ...(groups.length ? [this.undo, this.restoreAll()] : []),
      ...(this.rotors ? [this.group("rotors", [this.rotors.element])] : []),
      this.group("picture", this.picture(), !live),
      ...this.page.extra,
    );
  }

  /** A challenge is flown, or no longer: the hand moves in the plane for it, unless the person has chosen one. */
  challenged(on: boolean): void {
    const { hand } = this.page;
    if (hand.planeChosen) return;
    hand.plane = on ? "level" : "facing";
    if (this.planes) showChosen(this.planes, on ? 1 : 0);
  }

  showThrusts(values: Float32Array): void {
    this.rotors?.showThrusts(values);
  }

  markFailed(rotors: readonly number[]): void {
    this.rotors?.markFailed(rotors);
  }

  changed(key: string, value: ParameterValue, duration: number): void {
    this.editors.get(key)?.changed(value, duration);
    if (key === MAX_FORCE) this.force?.limit(Number(value));
  }

  /** Shows the reason at the parameter that it is about; false if there is none. */
  refused(what: string, reason: string): boolean {
    const editor = this.editors.get(what.replace(/^(set|restore) /, ""));
    editor?.refuse(reason);
    return editor !== undefined;
  }

  /** Parameters with the values that they had when the mission was first seen: a reset keeps what was changed. */
  private remembered({ mission, parameters }: FlightScene): SceneParameter[] {
    if (mission !== this.initial.mission) this.initial = { mission, values: new Map() };
    const { values } = this.initial;
    return parameters.map((one) => {
      if (!values.has(one.key)) values.set(one.key, one.initial ?? one.value);
      return { ...one, initial: values.get(one.key)! };
    });
  }

  private group(name: string, children: HTMLElement[], open = false): HTMLElement {
    const summary = el("summary", {}, name);
    return el("details", { open: this.open[name] ?? open, "data-name": name }, summary, ...children);
  }

  private hand(): HTMLElement[] {
    const { rows, force, planes } = handRows(this.page.hand);
    [this.force, this.planes] = [force, planes];
    return rows;
  }

  private picture(): HTMLElement[] {
    const graphics = choice("Graphics", { auto: "auto", full: "full", light: "light" }, this.page.graphicsChoice, (value) => {
      this.page.setGraphics(value);
    });
    const themes = { auto: "automatic", light: "light", dark: "dark" };
    const colours = choice("Colours", themes, this.page.theme, (value) => this.page.setTheme(value));
    return [row("Graphics", graphics), row("Colours", colours)];
  }

  private restoreAll(): HTMLElement {
    const all = el("button", { type: "button", class: "restore-all" }, icon("back"), "Restore all values");
    all.addEventListener("click", () => this.page.send({ type: "restore" }));
    return all;
  }
}
