// The controls of a replay: play, pace, and where in the flight one is.

import type { Scene } from "../wire/protocol.ts";
import type { Recorded } from "../wire/recorded.ts";
import { button, el, icon } from "./dom.ts";

const PACES = ["0.1", "0.25", "0.5", "1", "2", "4"];
const STEP = 1; // s, of an arrow key

export class Timeline {
  private readonly bar: HTMLInputElement;
  private readonly clock = el("b", {});
  private readonly player: HTMLButtonElement;
  private playing = true;

  constructor(
    place: HTMLElement,
    scene: Scene,
    private readonly flight: Recorded,
    film: () => void,
  ) {
    const { start, end, speed } = scene.replay!;
    this.bar = el("input", { type: "range", min: start, max: end, step: 0.01, value: start, "aria-label": "Time" });
    this.bar.addEventListener("input", () => {
      flight.go(this.bar.valueAsNumber);
    });
    this.player = button("pause", "", "Play or pause (P)", () => {
      this.toggle();
    });
    const options = PACES.map((pace) =>
      el("option", { value: pace, selected: Number(pace) === speed }, `\u00d7${pace}`),
    );
    const paces = el("select", { "aria-label": "Pace" }, ...options);
    paces.addEventListener("change", () => {
      flight.setSpeed(Number(paces.value));
      paces.blur();
    });
    const video = button("video", "Film", "Record a video of the picture", film, "film");
    const time = el("output", {}, this.clock, el("span", {}, ` / ${end.toFixed(1)} s`));
    place.replaceChildren(el("div", { class: "strip timeline" }, this.player, this.bar, time, paces, video));
  }

  toggle(): void {
    this.flight.play(!this.flight.playing);
  }

  step(ways: number): void {
    this.flight.go(this.bar.valueAsNumber + ways * STEP);
  }

  update(time: number): void {
    if (document.activeElement !== this.bar || this.flight.playing) this.bar.value = String(time);
    this.clock.textContent = time.toFixed(2);
    if (this.playing === this.flight.playing) return;
    this.playing = this.flight.playing;
    this.player.firstElementChild!.replaceWith(icon(this.playing ? "pause" : "play"));
  }
}
