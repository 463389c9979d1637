// A menu of missions in place of the mission's name.

import type { SceneMission } from "../wire/messages.generated.ts";
import { byId, el, menu } from "./dom.ts";

export class MissionMenu {
  private readonly menu: HTMLSelectElement;

  constructor(missions: readonly SceneMission[], chosen: (name: string) => void) {
    const options = missions.map(({ name, title }) => el("option", { value: name, title }, name));
    this.menu = menu({ id: "missions", title: "Mission", "aria-label": "Mission" }, chosen, true, options);
    byId("mission").hidden = true;
    byId("mission").after(this.menu);
  }

  /** Shows the mission that is flown, also one that the menu did not have. */
  show(name: string): void {
    const known = [...this.menu.options].some(({ value }) => value === name);
    if (!known) this.menu.prepend(el("option", { value: name }, name));
    this.menu.value = name;
  }
}
