// The buttons of a replay: play, speed, and a slider for the time.

import type { SceneReplay } from "../wire/messages.generated.ts";
import type { Replay } from "../wire/replay.ts";
import { button, el, icon } from "./dom.ts";

const SPEEDS = ["0.1", "0.25", "0.5", "1", "2", "4"];
const STEP = 1; // s, of an arrow key

export class Timeline {
  private readonly bar: HTMLInputElement;
  private readonly clock = el("b", {});
  private readonly player: HTMLButtonElement;
  private playing = true;

  constructor(
    place: HTMLElement,
    { start, end, speed }: SceneReplay,
    private readonly flight: Replay,
    record: () => void,
  ) {
    this.bar = el("input", { type: "range", min: start, max: end, step: 0.01, value: start, "aria-label": "Time" });
    this.bar.addEventListener("input", () => {
      flight.seek(this.bar.valueAsNumber);
    });
    this.player = button("pause", "", "Play or pause (P)", () => {
      this.toggle();
    });
    const options = SPEEDS.map((factor) =>
      el("option", { value: factor, selected: Number(factor) === speed }, `\u00d7${factor}`),
    );
    const speeds = el("select", { "aria-label": "Speed" }, ...options);
    speeds.addEventListener("change", () => {
      flight.setSpeed(Number(speeds.value));
      speeds.blur();
    });
    const video = button("video", "Video", "Record a video of the picture", record, "film");
    const time = el("output", {}, this.clock, el("span", {}, ` / ${end.toFixed(1)} s`));
    place.replaceChildren(el("div", { class: "strip timeline" }, this.player, this.bar, time, speeds, video));
  }

  toggle(): void {
    this.flight.play(!this.flight.playing);
  }

  step(direction: number): void {
    this.flight.seek(this.bar.valueAsNumber + direction * STEP);
  }

  update(time: number): void {
    if (document.activeElement !== this.bar || this.flight.playing) this.bar.value = String(time);
    this.clock.textContent = time.toFixed(2);
    if (this.playing === this.flight.playing) return;
    this.playing = this.flight.playing;
    this.player.firstElementChild!.replaceWith(icon(this.playing ? "pause" : "play"));
  }
}
