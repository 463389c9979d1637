// Building the page: elements by name, with texts as texts, never as markup.

type Attributes = Record<string, string | number | boolean | undefined>;
type Child = Node | string;

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

export function byId(id: string): HTMLElement {
  return document.getElementById(id)!;
}

const SVG = "http://www.w3.org/2000/svg";

export function svg(tag: string, attributes: Attributes = {}, ...children: Node[]): SVGElement {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

export function icon(name: string): SVGElement {
  return svg("svg", { "aria-hidden": "true" }, svg("use", { href: `#i-${name}` }));
}

/** A button with an icon and its name. */
export function button(name: string, text: string, title: string, act: () => void, kind = ""): HTMLButtonElement {
  const element = el("button", { type: "button", title, class: kind }, icon(name), el("span", {}, text));
  element.addEventListener("click", act);
  return element;
}

/**
 * Options to choose from. One that a person chose in the open list acts, and the focus goes back to the page; one that
 * was reached by arrow keys on the closed list acts too, or with `late` only on Enter or when the focus leaves.
 */
export function menu(
  attributes: Attributes,
  act: (value: string) => void,
  late: boolean,
  options: HTMLOptionElement[] = [],
): HTMLSelectElement {
  const select = el("select", attributes, ...options);
  let stepped = false;
  let waiting: string | null = null;
  const take = (): void => {
    const value = waiting;
    waiting = null;
    if (value !== null && value === select.value) act(value); // else another one was shown meanwhile
  };
  select.addEventListener("pointerdown", () => (stepped = false));
  select.addEventListener("keydown", ({ key, altKey }) => {
    stepped = !altKey && key !== " " && key !== "Enter"; // which open the list
    if (key === "Enter") take();
  });
  select.addEventListener("change", () => {
    waiting = select.value;
    if (!stepped || !late) take();
    if (!stepped) select.blur();
  });
  select.addEventListener("blur", take);
  return select;
}

/** One choice out of a few, side by side. */
export function choice<T extends string>(
  name: string,
  options: Record<T, string>,
  chosen: NoInfer<T>,
  act: (value: T) => void,
): HTMLElement {
  const buttons = (Object.keys(options) as T[]).map((value) => {
    const one = el("button", { type: "button", "aria-pressed": String(value === chosen) }, options[value]);
    one.addEventListener("click", () => {
      for (const other of buttons) other.setAttribute("aria-pressed", String(other === one));
      act(value);
    });
    return one;
  });
  return el("div", { class: "choice", role: "group", "aria-label": name }, ...buttons);
}

/** Shows another value of a `choice` as the chosen one, by its place. */
export function showChosen(group: HTMLElement, place: number): void {
  [...group.children].forEach((one, i) => one.setAttribute("aria-pressed", String(i === place)));
}

export function toggle(text: string, on: boolean, act: (on: boolean) => void): HTMLElement {
  const input = el("input", { type: "checkbox", checked: on });
  input.addEventListener("change", () => act(input.checked));
  return el("label", { class: "toggle" }, input, el("span", {}, text));
}

/** Lets a button show and hide a part of the page. */
export function foldable(name: string, part: string, open: boolean): void {
  const [handle, place] = [byId(name), byId(part)];
  const set = (on: boolean): void => {
    handle.setAttribute("aria-pressed", String(on));
    place.hidden = !on;
    document.body.classList.toggle(`no-${part}`, !on);
  };
  handle.addEventListener("click", () => set(place.hidden !== false));
  set(open);
}
