// A page for Node.js, which has none: elements that keep what they are given, and listeners.

/** What is kept of an element's classes, of its attributes, and of the browser's storage. */
class FakeClasses extends Set<string> {
  toggle(name: string, on: boolean): void {
    if (on) this.add(name);
    else this.delete(name);
  }

  contains(name: string): boolean {
    return this.has(name);
  }
}

export class FakeElement extends EventTarget {
  [property: string]: unknown;
  children: FakeElement[] = [];
  readonly attributes = new Map<string, string>();
  readonly classList = new FakeClasses();
  readonly dataset = {};
  textContent = "";
  value = "";
  open = false;
  focused = false;

  constructor(readonly tag: string) {
    super();
  }

  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }

  append(...children: (FakeElement | string)[]): void {
    for (const one of children) {
      if (typeof one === "string") this.textContent += one;
      else this.children.push(one);
    }
  }

  replaceChildren(...children: (FakeElement | string)[]): void {
    this.children = [];
    this.append(...children);
  }

  querySelector(tag: string): FakeElement | null {
    return this.children.find((one) => one.tag === tag) ?? null;
  }

  /** All elements of a tag below it. */
  querySelectorAll(tag: string): FakeElement[] {
    return this.children.flatMap((one) => [...(one.tag === tag ? [one] : []), ...one.querySelectorAll(tag)]);
  }

  /** Something happens to it. */
  event(type: string, properties: object = {}): void {
    this.dispatchEvent(Object.assign(new Event(type, { cancelable: true }), properties));
  }

  click(): void {
    this.event("click");
  }

  focus(): void {
    this.focused = true;
  }

  select(): void {
    this.focus();
  }

  blur(): void {
    this.focused = false;
    this.event("blur");
  }

  showModal(): void {
    this.open = true;
  }
}

class FakeDocument extends FakeElement {
  hidden = false;

  createElement(tag: string): FakeElement {
    return new FakeElement(tag);
  }

  createElementNS(_: string, tag: string): FakeElement {
    return new FakeElement(tag);
  }

  /** The element of a name; each there is from when it is asked for. */
  getElementById(id: string): FakeElement {
    const found = this.children.find(({ attributes }) => attributes.get("id") === id);
    if (found) return found;
    const one = new FakeElement("dialog");
    one.setAttribute("id", id);
    this.append(one);
    return one;
  }

  override querySelector(): FakeElement | null {
    return this.children.find(({ open }) => open) ?? null;
  }
}

export const page = new FakeDocument("html");
export const stored = new Map<string, string>();
const localStorage = {
  getItem: (name: string) => stored.get(name) ?? null,
  setItem: (name: string, text: string) => stored.set(name, text),
};
const timers = { setTimeout: () => 0, clearTimeout: () => undefined };
const window = Object.assign(new FakeElement("window"), timers, { localStorage });
Object.assign(globalThis, { document: page, window, HTMLInputElement: FakeDocument });

/** An element as the fake one that it is. */
export function fake(element: Element): FakeElement {
  return element as unknown as FakeElement;
}
