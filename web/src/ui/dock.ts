// The buttons of a live flight, below the picture.

import type { Outgoing, Status } from "../wire/protocol.ts";
import { button, el, icon } from "./dom.ts";

const PACES: Record<string, string> = { "1": "\u00d71", "0.5": "\u00d70.5", "0.25": "\u00d70.25", "0.1": "\u00d70.1" };

export class Dock {
  private paused = false;
  private enabled = true;
  private readonly pauser: HTMLButtonElement;
  private readonly listener: HTMLButtonElement;
  private readonly paces: HTMLSelectElement;
  private readonly video: HTMLButtonElement;

  constructor(
    place: HTMLElement,
    private readonly send: (message: Outgoing) => void,
    save: () => void,
    film: () => void,
  ) {
    this.pauser = button("pause", "Pause", "Stop time, or let it go on (P)", () => {
      send({ type: "pause", on: !this.paused });
    });
    this.listener = button("hand", "Enable", "Whether the pilot listens to pushes", () => {
      this.enable(!this.enabled);
      send({ type: "enable", on: this.enabled });
    });
    this.enable(true);
    this.paces = this.pace();
    this.video = button("video", "Film", "Record a video of the picture", film);
    place.replaceChildren(
      el("div", { class: "strip" }, ...this.requests(), this.listener),
      el("div", { class: "strip" }, this.pauser, this.paces, this.resetter()),
      el("div", { class: "strip" }, button("save", "Save", "Save what was flown so far", save), this.video),
    );
  }

  status(status: Status): void {
    if (status.paused !== this.paused) {
      this.paused = status.paused;
      const [name, text] = this.paused ? ["play", "Go on"] : ["pause", "Pause"];
      this.pauser.replaceChildren(icon(name), el("span", {}, text));
    }
    const pace = String(Number(status.speed.toPrecision(3)));
    if (document.activeElement !== this.paces && pace in PACES) this.paces.value = pace;
    if (status.enabled !== undefined) this.enable(status.enabled);
  }

  pause(): void {
    this.pauser.click();
  }

  filming(on: boolean): void {
    this.video.classList.toggle("filming", on);
    this.video.querySelector("span")!.textContent = on ? "End film" : "Film";
  }

  /** A new flight begins with an open ear. */
  renew(): void {
    this.enable(true);
  }

  private enable(on: boolean): void {
    this.enabled = on;
    this.listener.setAttribute("aria-pressed", String(on));
    this.listener.querySelector("span")!.textContent = on ? "Enabled" : "Disabled";
  }

  private requests(): HTMLButtonElement[] {
    const ask = (what: "lift" | "land" | "stop") => () => {
      this.send({ type: "ask", what });
    };
    return [
      button("lift", "Lift", "Lift off (L)", ask("lift"), "go"),
      button("land", "Land", "Land where it is (K)", ask("land")),
      button("stop", "Stop", "Stop all rotors now: what flies will fall", ask("stop"), "danger"),
    ];
  }

  private pace(): HTMLSelectElement {
    const options = Object.entries(PACES).map(([value, text]) => el("option", { value }, text));
    const select = el("select", { title: "Pace of time", "aria-label": "Pace of time" }, ...options);
    select.addEventListener("change", () => {
      this.send({ type: "speed", factor: Number(select.value) });
      select.blur();
    });
    return select;
  }

  private resetter(): HTMLButtonElement {
    return button("reset", "Reset", "Begin the flight again", () => {
      this.send({ type: "reset" });
    });
  }
}
