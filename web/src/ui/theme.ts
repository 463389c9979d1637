// Light or dark: what the person chose, which the browser keeps, or what the system prefers.

import type { Theme } from "../view/palette.ts";

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
  private kept = readChoice(storage()?.getItem(KEPT_AS) ?? null);

  constructor(private readonly changed: (theme: Theme) => void) {
    this.system.addEventListener("change", this.apply);
    this.apply();
  }

  get choice(): ThemeChoice {
    return this.kept;
  }

  choose(choice: ThemeChoice): void {
    this.kept = choice;
    storage()?.setItem(KEPT_AS, choice);
    this.apply();
  }

  private readonly apply = (): void => {
    const theme = themeOf(this.kept, this.system.matches);
    document.documentElement.dataset["theme"] = theme;
    this.changed(theme);
  };
}

/** The browser's storage; null where it is refused, as on pages without an origin. */
function storage(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}
