// The buttons of a live flight, below the picture.

import { LIMITS, type PageMessage, type StatusMessage } from "../wire/messages.generated.ts";
import { button, el, icon, menu } from "./dom.ts";
import { isAirborne } from "./phases.ts";
import type { Question } from "./question.ts";
import { RefusalNote } from "./refusal_note.ts";
import { Turns } from "./turns.ts";

const { min, max } = LIMITS.speed.factor;
const [LIFT, LAND] = ["Lift off (L)", "Land here (K)"];
const STOP = "Stop all rotors at once: the vehicle falls";
const OPEN = "Fly a mission of your own: a .toml file, which can also be dropped on the page";
const SPEEDS = [max, 0.5, 0.25, min].map(String);

/** What the buttons do beside sending messages. */
export interface DockActions {
  height: () => number | null; // of the vehicle above the floor, m
  open: () => void;
  save: () => void;
  film: () => void;
}

export class Dock {
  private readonly note = new RefusalNote();
  private readonly turns: Turns;
  private readonly asking: Record<"lift" | "land", HTMLButtonElement>;
  private paused = false;
  private enabled = true;
  private airborne = false;
  private readonly pauseButton: HTMLButtonElement;
  private readonly enableButton: HTMLButtonElement;
  private readonly speeds: HTMLSelectElement;
  private readonly videoButton: HTMLButtonElement;
  private readonly openButton: HTMLButtonElement;

  constructor(
    place: HTMLElement,
    private readonly send: (message: PageMessage) => void,
    private readonly question: Question,
    private readonly actions: DockActions,
  ) {
    this.pauseButton = button("pause", "Pause", "Pause or continue (P)", () => {
      this.pause(!this.paused);
      send({ type: "pause", on: this.paused });
    });
    this.enableButton = button("hand", "", "Whether the pilot follows pushes", () => {
      this.enable(!this.enabled);
      send({ type: "enable", on: this.enabled });
    });
    this.enable(true);
    this.speeds = this.speedChoice();
    this.openButton = button("open", "Open", OPEN, actions.open);
    this.videoButton = button("video", "Video", "Record a video of the picture", actions.film);
    this.asking = { lift: this.request("lift", LIFT, "go"), land: this.request("land", LAND) };
    const stop = button("stop", "Stop", STOP, () => this.stop(), "danger");
    const keep = button("save", "Save", "Save the flight so far", actions.save);
    this.turns = new Turns(send);
    place.replaceChildren(
      this.note.element,
      this.turns.element,
      el("div", { class: "strip" }, this.asking.lift, this.asking.land, stop, this.enableButton),
      el("div", { class: "strip" }, this.pauseButton, this.speeds, this.resetButton()),
      el("div", { class: "strip" }, this.openButton, keep, this.videoButton),
    );
  }

  status(status: StatusMessage): void {
    this.pause(status.paused);
    const speed = String(Number(status.speed.toPrecision(3)));
    if (document.activeElement !== this.speeds && SPEEDS.includes(speed)) this.speeds.value = speed;
    this.enable(status.enabled);
    this.turns.status(status);
    const { lift, land } = status.refusals;
    mark(this.asking.lift, lift, LIFT);
    mark(this.asking.land, land, LAND);
    if (!status.paused) this.note.status(status);
    this.airborne = isAirborne(status.phase);
    if (!this.airborne) this.question.withdraw();
  }

  /** Asks the pilot to lift off or to land. */
  ask(what: "lift" | "land"): void {
    this.note.ask(what);
    if (this.paused) this.note.refused("The flight is paused. Press Continue, and the pilot is asked.");
    this.send({ type: "ask", what });
  }

  /** Stops the rotors; in the air only after a question. */
  private stop(): void {
    const stop = (): void => this.send({ type: "ask", what: "stop" });
    const height = this.actions.height();
    const from = height === null ? "" : ` from ${height.toFixed(1)} m`;
    if (this.airborne) this.question.ask("Stop all rotors?", `The rotors stop and it falls${from}.`, "Stop", stop);
    else stop();
  }

  /** A request is refused. */
  refused(reason: string): void {
    this.note.refused(reason);
  }

  togglePause(): void {
    this.pauseButton.click();
  }

  filming(on: boolean): void {
    this.videoButton.classList.toggle("filming", on);
    this.videoButton.querySelector("span")!.textContent = on ? "End video" : "Video";
  }

  /** A new flight begins enabled; `files`: whether it may be followed by that of a file. */
  reset(files: boolean): void {
    this.enable(true);
    this.openButton.hidden = !files;
  }

  private pause(on: boolean): void {
    if (on === this.paused) return;
    this.paused = on;
    const [name, text] = on ? ["play", "Continue"] : ["pause", "Pause"];
    this.pauseButton.replaceChildren(icon(name), el("span", {}, text));
  }

  private enable(on: boolean): void {
    this.enabled = on;
    this.enableButton.setAttribute("aria-pressed", String(on));
    this.enableButton.querySelector("span")!.textContent = on ? "Follows me" : "Does not follow";
  }

  private request(what: "lift" | "land", title: string, kind?: string): HTMLButtonElement {
    const ask = (): void => this.ask(what);
    const one = button(what, what === "lift" ? "Lift" : "Land", title, ask, kind);
    this.note.listen(one, what);
    return one;
  }

  private speedChoice(): HTMLSelectElement {
    const options = SPEEDS.map((value) => el("option", { value }, `\u00d7${value}`));
    const name = "Speed of the flight";
    const act = (factor: string): void => this.send({ type: "speed", factor: Number(factor) });
    return menu({ title: name, "aria-label": name }, act, false, options);
  }

  private resetButton(): HTMLButtonElement {
    return button("reset", "Reset", "Begin the flight again", () => this.send({ type: "reset" }));
  }
}

/** A button of a request that would be refused is grey and described by the reason; it can be pressed all the same. */
function mark(element: HTMLButtonElement, reason: string, title: string): void {
  element.setAttribute("aria-disabled", String(reason !== ""));
  if (element.title !== (reason || title)) element.title = reason || title;
}
