// Light or dark: what the person chose, which the browser keeps, or what the system prefers.

import type { Theme } from "../view/palette.ts";
import { keep, kept } from "./storage.ts";

export type ThemeChoice = "auto" | Theme;

const KEPT_AS = "tandemlift.colours";

/** The choice that a stored text stands for. */
export function readChoice(text: string | null): ThemeChoice {
  return text === "light" || text === "dark" ? text : "auto";
}

/** The theme of a choice on a system that prefers dark colours, or not. */
export function themeOf(choice: ThemeChoice, prefersDark: boolean): Theme {
  if (choice !== "auto") return choice;
  return prefersDark ? "dark" : "light";
}

/** Sets the theme of the style sheet, now and whenever choice or system change, and calls `changed` each time. */
export class ThemeSwitch {
  private readonly system = window.matchMedia("(prefers-color-scheme: dark)");
  private chosen = readChoice(kept(KEPT_AS));

  constructor(private readonly changed: (theme: Theme) => void) {
    this.system.addEventListener("change", this.apply);
    this.apply();
  }

  get choice(): ThemeChoice {
    return this.chosen;
  }

  choose(choice: ThemeChoice): void {
    this.chosen = choice;
    keep(KEPT_AS, choice);
    this.apply();
  }

  private readonly apply = (): void => {
    const theme = themeOf(this.chosen, this.system.matches);
    document.documentElement.dataset["theme"] = theme;
    this.changed(theme);
  };
}
