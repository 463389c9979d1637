// The colours of the style sheet for what is drawn on a canvas, so that they have one home.

import { el } from "./dom.ts";

/** A custom property of the style sheet that is a colour. */
export type ColorName = `--${string}`;

const known = new Map<ColorName, string>();

/** The colour in the present theme. */
export function color(name: ColorName): string {
  const found = known.get(name) ?? read(name);
  known.set(name, found);
  return found;
}

/** To be called when the theme has changed. */
export function forgetColors(): void {
  known.clear();
}

/** As computed for an element: the property itself may hold one colour for each theme. */
function read(name: ColorName): string {
  const probe = el("i", { hidden: true });
  probe.style.color = `var(${name})`;
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}
