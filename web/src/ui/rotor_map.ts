// The vehicle from above: each rotor is filled by its thrust; two presses stop it for good.

import type { FlightScene, PageMessage, ScenePayload, SceneQuadrotor } from "../wire/messages.generated.ts";
import { ahead } from "../view/rotors.ts";
import { el, svg } from "./dom.ts";

const CONFIRM_WITHIN = 3000; // ms, for the second press

export class RotorMap {
  readonly element: HTMLElement;
  private readonly fills: SVGElement[] = [];
  private readonly buttons: SVGElement[] = [];
  private readonly maxThrusts: number[];
  private readonly note = el("p", { class: "note", role: "status" });
  private armed = -1;
  private timer = 0;

  constructor(
    scene: FlightScene,
    private readonly send: (message: PageMessage) => void,
  ) {
    const { quadrotors, payload } = scene.vehicle;
    this.maxThrusts = quadrotors.flatMap((q) => q.rotors.map((r) => r.max_thrust));
    // seen from above with x up and y to the left
    const half =
      Math.max(payload.length / 2, ...quadrotors.map((q) => Math.abs(q.position[1]) + q.guard)) + 0.05;
    const deep = Math.max(0.2, ...quadrotors.map((q) => Math.abs(q.position[0]) + q.guard)) + 0.05;
    const viewBox = [-half, -deep, 2 * half, 2 * deep].join(" ");
    const picture = svg("svg", { viewBox, class: "rotormap" }, beam(payload));
    for (const quadrotor of quadrotors) {
      const [x, y] = quadrotor.position;
      picture.append(svg("circle", { class: "guard", cx: -y, cy: -x, r: quadrotor.guard }));
      quadrotor.rotors.forEach((_, i) => picture.append(this.rotor(quadrotor, i)));
    }
    this.element = el("div", { class: "rotors" }, picture, this.note);
    this.arm(-1);
    this.markFailed([]);
  }

  showThrusts(values: Float32Array): void {
    this.fills.forEach((fill, i) => {
      fill.setAttribute("fill-opacity", Math.min(values[i] / this.maxThrusts[i], 1).toFixed(2));
    });
  }

  /** Marks the rotors that have stopped for good. */
  markFailed(rotors: readonly number[]): void {
    this.buttons.forEach((spot, i) => {
      const failed = rotors.includes(i);
      spot.classList.toggle("failed", failed);
      spot.setAttribute("aria-disabled", String(failed));
      spot.setAttribute("aria-label", failed ? `Rotor ${i + 1}, stopped` : `Stop rotor ${i + 1}`);
    });
  }

  private rotor(quadrotor: SceneQuadrotor, i: number): SVGElement {
    const { position, radius } = quadrotor.rotors[i];
    const number = this.buttons.length;
    const place = { cx: -position[1], cy: -position[0], r: 0.92 * radius };
    const fill = svg("circle", { ...place, class: ahead(quadrotor, i) ? "front" : "rear" });
    const rim = svg("circle", { ...place, class: "rim" });
    const cross = 0.5 * radius;
    const arm = 2 * cross;
    const path = `M${place.cx - cross} ${place.cy - cross}l${arm} ${arm}m0 ${-arm}l${-arm} ${arm}`;
    const spot = svg("g", { role: "button", tabindex: 0 }, fill, rim, svg("path", { d: path }));
    spot.addEventListener("click", () => this.press(number));
    spot.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault(); // Space would scroll
      this.press(number);
    });
    this.fills.push(fill);
    this.buttons.push(spot);
    return spot;
  }

  private press(rotor: number): void {
    if (this.buttons[rotor].classList.contains("failed")) return;
    window.clearTimeout(this.timer);
    if (this.armed === rotor) {
      this.send({ type: "kill", rotor });
      this.arm(-1);
      return;
    }
    this.arm(rotor);
    this.timer = window.setTimeout(() => this.arm(-1), CONFIRM_WITHIN);
  }

  private arm(rotor: number): void {
    this.armed = rotor;
    this.buttons.forEach((spot, i) => spot.classList.toggle("armed", i === rotor));
    this.note.textContent =
      rotor < 0 ? "Press a rotor twice to stop it." : `Press rotor ${rotor + 1} again to stop it for good.`;
  }
}

function beam({ length, width, position }: ScenePayload): SVGElement {
  const across = Math.max(width, 0.06);
  return svg("rect", { class: "beam", x: -length / 2 - position[1], y: -across / 2, width: length, height: across });
}
