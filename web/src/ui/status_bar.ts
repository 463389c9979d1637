// The bar on top: phase, time, real-time factor, latency, who holds the beam, who watches.

import type { Frame } from "../wire/frames.ts";
import type { FlightScene, StatusMessage } from "../wire/messages.generated.ts";
import { byId, el } from "./dom.ts";
import { badgeOf } from "./phases.ts";

const HOLDERS = { you: "you", other: "another page", none: "nobody" };
const SHARE = "Of what the rotors counter in hover: the largest part, of force across, up, down and of the moment about an axis";
const LATE = 0.97; // real-time factor below which the number is marked

/** The largest share of the rotors that the true push takes, of force across, up or down and moment about each axis. */
export function takenBy(frame: Frame, [across, up, down, ...about]: readonly number[]): number {
  const [x, y, z] = frame.vector("push");
  const turning = frame.vector("push_moment").map((part, i) => Math.abs(part) / about[i]);
  return Math.max(Math.hypot(x, y) / across, z / (z > 0 ? up : -down), ...turning);
}

export class StatusBar {
  private readonly values = new Map<string, HTMLElement>();
  private readonly badge = byId("mode");
  private readonly share = el("meter", { max: 1, low: 0.5, high: 0.85, optimum: 0, title: SHARE });
  private authority: readonly number[] | undefined;
  private taken = 0;

  /** `alone`: no other page can watch or hold this flight. */
  constructor(replay: boolean, alone: boolean) {
    const shared = alone ? [] : ["held by", "viewers"];
    const live = replay ? ["time"] : ["time", "hand takes", "speed", "latency", ...shared, "recorded"];
    const meters = [...live, "frame rate"].map((name) => {
      const value = el("dd", {}, "\u2013");
      this.values.set(name, value);
      return el("div", { class: name.replace(" ", "-") }, el("dt", {}, name), value);
    });
    byId("meters").replaceChildren(...meters);
    this.values.get("hand takes")?.parentElement!.append(this.share);
  }

  scene({ mission, controller, engine, version, authority }: FlightScene): void {
    this.authority = authority;
    this.share.parentElement?.toggleAttribute("hidden", !authority); // rotors without limits
    byId("mission").textContent = mission;
    byId("controller").textContent = controller;
    byId("mission").title = `engine ${engine}, version ${version}`;
    document.title = `${mission} \u00b7 tandemlift`;
  }

  status(status: StatusMessage): void {
    const { text, kind } = badgeOf(status);
    this.badge.textContent = status.paused ? `paused \u00b7 ${text}` : text;
    this.badge.className = `badge ${kind}`;
    const { factor } = status;
    const late = !status.paused && !status.preparing && factor < LATE * status.speed;
    this.set("speed", `\u00d7${factor.toFixed(2)}`, late ? `late by ${status.behind_ms.toFixed(0)} ms` : "");
    this.set("held by", HOLDERS[status.holder]);
    this.set("viewers", String(status.viewers));
    this.set("recorded", `${status.recorded_s.toFixed(0)} s`);
  }

  /** Keeps the largest share of the rotors that the hands have taken since it was shown. */
  frame(frame: Frame): void {
    if (this.authority) this.taken = Math.max(this.taken, takenBy(frame, this.authority));
  }

  /** A few times a second: what changes with every picture. */
  update(frame: Frame | null, latency: number | null, rate: number | null): void {
    if (frame) this.set("time", `${frame.scalar("time").toFixed(1)} s`);
    if (this.authority) this.set("hand takes", `${(100 * this.taken).toFixed(0)} %`, this.taken > 1 ? SHARE : "");
    [this.share.value, this.taken] = [this.taken, 0];
    this.set("latency", latency === null ? "\u2013" : `${latency.toFixed(0)} ms`);
    this.set("frame rate", rate === null ? "at rest" : `${rate.toFixed(0)}/s`);
  }

  disconnected(): void {
    this.badge.textContent = "no connection";
    this.badge.className = "badge off";
  }

  private set(name: string, text: string, warning = ""): void {
    const value = this.values.get(name);
    if (!value) return;
    if (value.textContent !== text) value.textContent = text;
    value.title = warning;
    value.classList.toggle("late", warning !== "");
  }
}
