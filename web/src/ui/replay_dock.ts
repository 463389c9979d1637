// The buttons of a replay, beside its timeline: play, speed, video.

import type { SceneReplay } from "../wire/messages.generated.ts";
import type { Replay } from "../wire/replay.ts";
import { button, el, icon, menu } from "./dom.ts";

const SPEEDS = ["0.1", "0.25", "0.5", "1", "2", "4"];
const STEP = 1; // s, of an arrow key

export class ReplayDock {
  private readonly clock = el("b", {});
  private readonly player: HTMLButtonElement;
  private playing = true;
  private time = 0;

  constructor(
    place: HTMLElement,
    { end, speed }: SceneReplay,
    private readonly flight: Replay,
    timeline: HTMLElement,
    record: () => void,
  ) {
    this.player = button("pause", "", "Play or pause (P)", () => this.toggle());
    const options = SPEEDS.map((factor) =>
      el("option", { value: factor, selected: Number(factor) === speed }, `\u00d7${factor}`),
    );
    const speeds = menu({ "aria-label": "Speed" }, (factor) => flight.setSpeed(Number(factor)), false, options);
    const video = button("video", "Video", "Record a video of the picture", record, "film");
    const time = el("output", {}, this.clock, el("span", {}, ` / ${end.toFixed(1)} s`));
    place.replaceChildren(el("div", { class: "strip player" }, this.player, timeline, time, speeds, video));
  }

  toggle(): void {
    this.flight.play(!this.flight.playing);
  }

  step(direction: number): void {
    this.flight.seek(this.time + direction * STEP);
  }

  update(time: number): void {
    this.time = time;
    this.clock.textContent = time.toFixed(2);
    if (this.playing === this.flight.playing) return;
    this.playing = this.flight.playing;
    this.player.firstElementChild!.replaceWith(icon(this.playing ? "pause" : "play"));
  }
}
