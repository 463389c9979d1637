// The buttons of a live flight, below the picture.

import { LIMITS, type PageMessage, type StatusMessage } from "../wire/messages.generated.ts";
import { button, el, icon } from "./dom.ts";

const { min, max } = LIMITS.speed.factor;
const SPEEDS = [max, 0.5, 0.25, min].map(String);

export class Dock {
  private paused = false;
  private enabled = true;
  private readonly pauseButton: HTMLButtonElement;
  private readonly enableButton: HTMLButtonElement;
  private readonly speeds: HTMLSelectElement;
  private readonly videoButton: HTMLButtonElement;

  constructor(
    place: HTMLElement,
    private readonly send: (message: PageMessage) => void,
    save: () => void,
    film: () => void,
  ) {
    this.pauseButton = button("pause", "Pause", "Pause or continue (P)", () => {
      send({ type: "pause", on: !this.paused });
    });
    this.enableButton = button("hand", "Enable", "Whether the pilot follows pushes", () => {
      this.enable(!this.enabled);
      send({ type: "enable", on: this.enabled });
    });
    this.enable(true);
    this.speeds = this.speedChoice();
    this.videoButton = button("video", "Video", "Record a video of the picture", film);
    place.replaceChildren(
      el("div", { class: "strip" }, ...this.requests(), this.enableButton),
      el("div", { class: "strip" }, this.pauseButton, this.speeds, this.resetButton()),
      el("div", { class: "strip" }, button("save", "Save", "Save the flight so far", save), this.videoButton),
    );
  }

  status(status: StatusMessage): void {
    if (status.paused !== this.paused) {
      this.paused = status.paused;
      const [name, text] = this.paused ? ["play", "Continue"] : ["pause", "Pause"];
      this.pauseButton.replaceChildren(icon(name), el("span", {}, text));
    }
    const speed = String(Number(status.speed.toPrecision(3)));
    if (document.activeElement !== this.speeds && SPEEDS.includes(speed)) this.speeds.value = speed;
    this.enable(status.enabled);
  }

  togglePause(): void {
    this.pauseButton.click();
  }

  filming(on: boolean): void {
    this.videoButton.classList.toggle("filming", on);
    this.videoButton.querySelector("span")!.textContent = on ? "End video" : "Video";
  }

  /** A new flight begins enabled. */
  reset(): void {
    this.enable(true);
  }

  private enable(on: boolean): void {
    this.enabled = on;
    this.enableButton.setAttribute("aria-pressed", String(on));
    this.enableButton.querySelector("span")!.textContent = on ? "Enabled" : "Disabled";
  }

  private requests(): HTMLButtonElement[] {
    const ask = (what: "lift" | "land" | "stop") => () => {
      this.send({ type: "ask", what });
    };
    return [
      button("lift", "Lift", "Lift off (L)", ask("lift"), "go"),
      button("land", "Land", "Land here (K)", ask("land")),
      button("stop", "Stop", "Stop all rotors at once: the vehicle falls", ask("stop"), "danger"),
    ];
  }

  private speedChoice(): HTMLSelectElement {
    const options = SPEEDS.map((value) => el("option", { value }, `\u00d7${value}`));
    const select = el("select", { title: "Speed of the flight", "aria-label": "Speed of the flight" }, ...options);
    select.addEventListener("change", () => {
      this.send({ type: "speed", factor: Number(select.value) });
      select.blur();
    });
    return select;
  }

  private resetButton(): HTMLButtonElement {
    return button("reset", "Reset", "Begin the flight again", () => {
      this.send({ type: "reset" });
    });
  }
}
