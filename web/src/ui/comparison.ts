// Two flights under one hand: the menu that begins a comparison, and in words what differs.

import type { SceneMission, SceneParameter } from "../wire/messages.generated.ts";
import { same } from "../wire/parameters.ts";
import type { Compare, Comparing, FlownScene, FlownStatus } from "../wire/source.ts";
import { button, el, menu } from "./dom.ts";
import { worded } from "./numbers.ts";

const KEEP = "keep these settings as a ghost";
const SAME = "The ghost has the same settings: change one, and see.";

export class Comparison {
  readonly menu: HTMLSelectElement;
  readonly element = el("div", { id: "comparison", class: "refusal-row", hidden: true });
  private readonly text = el("span");
  private readonly ended = el("span");

  constructor(compare: Compare | undefined) {
    const choose = (mission: string): void => {
      this.menu.selectedIndex = 0;
      compare?.(mission ? "fly" : "keep", mission);
    };
    this.menu = menu({ title: "Fly a second flight under the same hand", "aria-label": "Compare" }, choose, true);
    const act = (what: Comparing) => () => compare?.(what);
    const swap = button("again", "Swap", "Fly the ghost, and let this flight be the ghost", act("swap"));
    const end = button("close", "End", "Fly without a ghost", act("end"));
    this.element.append(el("div", { class: "strip" }, el("p", { role: "status" }, this.text, this.ended), swap, end));
  }

  begin(companions: readonly SceneMission[] = []): void {
    const entries = companions.map(({ name, title }) =>
      el("option", { value: name, title }, `with ${name}, from the start`),
    );
    const keep = el("option", { value: "" }, KEEP);
    this.menu.replaceChildren(el("option", { hidden: true }, "Compare \u2026"), keep, ...entries);
  }

  /** Says how a ghost has ended; nothing while it flies. */
  status({ ghost = "" }: FlownStatus): void {
    if (this.ended.textContent !== ghost) this.ended.textContent = ghost && ` The ghost ${ghost}.`;
  }

  /** Says what differs; `scene`: with the settings as they are now. */
  show({ mission, controller, parameters, ghost }: FlownScene): void {
    this.element.hidden = !ghost;
    if (!ghost) return;
    const name = (one: { mission: string; controller: string }): string => `${one.mission} (${one.controller})`;
    const other = ghost.mission === mission ? "" : `Ghost: ${name(ghost)}, now: ${name({ mission, controller })}. `;
    this.text.textContent = other + differences(ghost.parameters, parameters) || SAME;
  }
}

/** In words, the values in which a ghost differs from the flight. */
export function differences(ghost: readonly SceneParameter[], now: readonly SceneParameter[]): string {
  const all = now.flatMap(({ key, label, group, value, unit }) => {
    const before = ghost.find((one) => one.key === key);
    if (!before || same(before.value, value)) return [];
    const name = now.filter((one) => one.label === label).length > 1 ? `${group} ${label}` : label;
    return [`${name} ${worded(before.value)}, now: ${worded(value)} ${unit ?? ""}`.trim()];
  });
  return all.length ? `Ghost: ${all.join("; ")}.` : "";
}
