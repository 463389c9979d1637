// Settings that were changed in flight, taken back and made again.

import type { PageMessage, ParameterValue, SceneParameter } from "../wire/messages.generated.ts";
import { button, el } from "./dom.ts";

const TOGETHER = 50; // ms, within which changes are one, as those of "Restore all values"

interface Change {
  key: string;
  before: ParameterValue;
  after: ParameterValue;
}

export class Undo {
  readonly element: HTMLElement;
  private readonly values = new Map<string, string>(); // as JSON
  private readonly awaited = new Map<string, string>(); // on their way, by an undo or a redo
  private done: Change[][] = [];
  private undone: Change[][] = [];
  private last = -Infinity; // ms
  private readonly buttons: HTMLButtonElement[];

  constructor(private readonly send: (message: PageMessage) => number | null) {
    this.buttons = [
      button("back", "Undo", "Take the last change of a setting back (Ctrl+Z)", () => this.undo()),
      button("again", "Redo", "Make it again (Ctrl+Shift+Z)", () => this.redo()),
    ];
    this.element = el("div", { class: "undo" }, ...this.buttons);
    this.show();
  }

  /** The settings of a flight; other values than those known are those of another flight, or of another time. */
  scene(parameters: readonly SceneParameter[]): void {
    const news = parameters.filter(({ key, value }) => (this.values.get(key) ?? "") !== JSON.stringify(value));
    for (const { key, value } of parameters) this.values.set(key, JSON.stringify(value));
    if (news.length) [this.done, this.undone] = [[], []];
    this.awaited.clear();
    this.show();
  }

  changed(key: string, value: ParameterValue, now: number): void {
    const [before, after] = [this.values.get(key), JSON.stringify(value)];
    this.values.set(key, after);
    if (this.awaited.get(key) === after) {
      this.awaited.delete(key);
      return;
    }
    if (before === undefined || before === after) return;
    const change = { key, before: JSON.parse(before) as ParameterValue, after: value };
    if (now - this.last < TOGETHER) this.done.at(-1)?.push(change);
    else this.done.push([change]);
    [this.last, this.undone] = [now, []];
    this.show();
  }

  undo(): void {
    const group = [...(this.done.at(-1) ?? [])].reverse();
    if (group.every(({ key, before }) => this.set(key, before))) this.undone.push(...this.done.splice(-1));
    this.show();
  }

  redo(): void {
    const group = this.undone.at(-1) ?? [];
    if (group.every(({ key, after }) => this.set(key, after))) this.done.push(...this.undone.splice(-1));
    this.show();
  }

  /** Whether a key pressed is one of these; not in a dialog, nor while a number is written, whose own undo that is. */
  key({ ctrlKey, metaKey, shiftKey, key, target }: KeyboardEvent): boolean {
    const writes = target instanceof HTMLInputElement && target.value !== target.defaultValue && target.type !== "range";
    const letter = key.toLowerCase(); // where it stands on the keyboard differs from country to country
    if (!(ctrlKey || metaKey) || writes || !["z", "y"].includes(letter)) return false;
    if (document.querySelector("dialog[open]")) return false;
    if (shiftKey || letter === "y") this.redo();
    else this.undo();
    return true;
  }

  /** Sends a value; false if it is not sent, as no flight is connected. */
  private set(key: string, value: ParameterValue): boolean {
    this.last = -Infinity;
    this.awaited.set(key, JSON.stringify(value));
    if (this.send({ type: "set", key, value }) !== null) return true;
    this.awaited.delete(key);
    return false;
  }

  private show(): void {
    this.buttons[0].disabled = this.done.length === 0;
    this.buttons[1].disabled = this.undone.length === 0;
  }
}
