// Small texts over the picture that move with what they label.

import type { PerspectiveCamera, Vector3 } from "three";

const GAP = 12; // pixels that a label keeps to the sides of the picture
const KINDS = ["push", "moment", "wind", "contact", "ending", "refusal"] as const; // those before stand, the others give way

export type Labels = Record<(typeof KINDS)[number], Label>;

/** The labels of a picture, none of which covers another. */
export function labelsIn(layer: HTMLElement): Labels {
  const all: Label[] = [];
  for (const kind of KINDS) all.push(new Label(layer, kind, [...all]));
  return Object.fromEntries(KINDS.map((kind, i) => [kind, all[i]])) as Labels;
}

export class Label {
  private readonly element: HTMLElement;
  private text = "";
  private width = 0;
  private height = 0;
  private own: [left: number, top: number, width: number, height: number] = [0, 0, 0, 0]; // from the place that it labels
  private at: [x: number, y: number] = [0, 0]; // of its upper left corner

  /** `before`: labels that it moves below where it would cover them. */
  constructor(
    layer: HTMLElement,
    kind: string,
    private readonly before: readonly Label[],
  ) {
    this.element = document.createElement("div");
    this.element.className = `label ${kind}`;
    this.element.hidden = true;
    layer.append(this.element);
    // read here: reading it with every picture would force a layout each time
    new ResizeObserver(() => ([this.width, this.height] = [layer.clientWidth, layer.clientHeight])).observe(layer);
  }

  hide(): void {
    if (!this.element.hidden) this.element.hidden = true;
  }

  show(text: string, place: Vector3, camera: PerspectiveCamera): void {
    const spot = place.clone().project(camera);
    if (Math.abs(spot.z) > 1) {
      this.hide();
      return;
    }
    if (this.element.hidden) this.element.hidden = false;
    if (text !== this.text) {
      const { element } = this;
      element.textContent = this.text = text;
      this.own = [element.offsetLeft, element.offsetTop, element.offsetWidth, element.offsetHeight];
    }
    const [left, top, width, height] = this.own;
    const x = Math.min((spot.x / 2 + 0.5) * this.width, this.width - width - GAP);
    const y = Math.min((0.5 - spot.y / 2) * this.height, this.height - height - GAP);
    this.at = [Math.max(x, -GAP) + left, y + top];
    for (let one = this.covered(); one; one = this.covered()) this.at[1] = one.at[1] + one.own[3];
    this.element.style.transform = `translate(${(this.at[0] - left).toFixed(1)}px, ${(this.at[1] - top).toFixed(1)}px)`;
  }

  private covered(): Label | undefined {
    const meets = (one: Label, i: 0 | 1): boolean =>
      this.at[i] < one.at[i] + one.own[i + 2] && one.at[i] < this.at[i] + this.own[i + 2];
    return this.before.find((one) => !one.element.hidden && meets(one, 0) && meets(one, 1));
  }
}
