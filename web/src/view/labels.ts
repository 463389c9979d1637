// Small texts over the picture that move with what they label.

import type { PerspectiveCamera, Vector3 } from "three";

const GAP = 12; // pixels that a label keeps to the sides of the picture

export class Label {
  private readonly element: HTMLElement;
  private text = "";
  private width = 0;
  private height = 0;
  private own: [width: number, height: number] = [0, 0];

  constructor(layer: HTMLElement, kind: string) {
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
    const hidden = Math.abs(spot.z) > 1;
    if (hidden !== this.element.hidden) this.element.hidden = hidden;
    if (text !== this.text) {
      this.element.textContent = this.text = text;
      this.own = [this.element.offsetWidth, this.element.offsetHeight];
    }
    const x = Math.min((spot.x / 2 + 0.5) * this.width, this.width - this.own[0] - GAP);
    const y = Math.min((0.5 - spot.y / 2) * this.height, this.height - this.own[1] - GAP);
    this.element.style.transform = `translate(${Math.max(x, -GAP).toFixed(1)}px, ${y.toFixed(1)}px)`;
  }
}
