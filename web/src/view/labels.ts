// Small texts over the picture that stay with what they name.

import type { PerspectiveCamera, Vector3 } from "three";

export class Label {
  private readonly element: HTMLElement;
  private text = "";

  constructor(layer: HTMLElement, kind: string) {
    this.element = document.createElement("div");
    this.element.className = `label ${kind}`;
    this.element.hidden = true;
    layer.append(this.element);
  }

  hide(): void {
    this.element.hidden = true;
  }

  show(text: string, place: Vector3, camera: PerspectiveCamera): void {
    const spot = place.clone().project(camera);
    const layer = this.element.parentElement!;
    this.element.hidden = Math.abs(spot.z) > 1;
    if (text !== this.text) this.element.textContent = this.text = text;
    const [x, y] = [(spot.x / 2 + 0.5) * layer.clientWidth, (0.5 - spot.y / 2) * layer.clientHeight];
    this.element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }
}
