// Everything around the picture: bar, panel, plots, buttons, notices, and the keys that press them.

import type { App } from "../app.ts";
import { typing, type Ways } from "../hand/pushes.ts";
import type { View } from "../view/follow.ts";
import type { Choice } from "../view/graphics.ts";
import type { Frame } from "../wire/frames.ts";
import { perAxis, type Scene, type Setting, type Status, THRESHOLD } from "../wire/protocol.ts";
import { help, saving, stamp } from "./dialogs.ts";
import { Dock } from "./dock.ts";
import { byId, choice, toggle } from "./dom.ts";
import { SPAN } from "./history.ts";
import { Notices } from "./notices.ts";
import { Panel } from "./panel.ts";
import { Plots } from "./plots.ts";
import { Readout } from "./readout.ts";
import { Timeline } from "./timeline.ts";
import { Film } from "./video.ts";

const TEXT_EVERY = 200; // ms
const PLOT_EVERY = { full: 30, light: 110 }; // ms; each plot has its turn at a fourth of this rate
const VIEWS: Record<View, string> = { behind: "behind", side: "side", above: "above" };
const NARROW = 900; // pixels: where the panel covers the picture, it starts closed
const LOW = 380; // pixels of height: no room for plots to begin with

export class Frontend {
  private readonly notices: Notices;
  private readonly readout: Readout;
  private readonly panel: Panel;
  private readonly help: HTMLDialogElement;
  private readonly film = new Film();
  private plots: Plots | null = null;
  private dock: Dock | null = null;
  private timeline: Timeline | null = null;
  private mission = "flight";
  private pulled = false;
  private texts = 0;
  private drawn = 0;

  constructor(private readonly app: App) {
    this.notices = new Notices(() => {
      app.retry();
    });
    this.readout = new Readout(app.replay !== null);
    this.panel = this.makePanel();
    this.help = help(app.replay !== null);
    byId("show-help").addEventListener("click", () => {
      this.help.showModal();
    });
    fold("show-panel", "panel", window.innerWidth >= NARROW && app.replay === null);
    fold("show-plots", "plots", window.innerHeight >= LOW);
    this.makeViews();
    if (!app.replay) this.makeDock();
    window.addEventListener("keydown", this.key);
  }

  get filming(): boolean {
    return this.film.running;
  }

  scene(scene: Scene): void {
    this.mission = scene.mission;
    this.readout.scene(scene);
    this.panel.scene(scene);
    this.plots = new Plots(scene, byId("plots"), this.app.level);
    this.dock?.renew();
    if (!this.app.replay) return;
    this.timeline = new Timeline(byId("dock"), scene, this.app.replay, () => {
      this.toggleFilm();
    });
  }

  frame(frame: Frame): void {
    const jumped = this.plots?.add(frame) ?? false;
    if (jumped && this.app.replay) for (const past of this.app.replay.before(SPAN)) this.plots?.add(past);
    if (frame.scalar("held") > 0) this.pulled = true;
  }

  status(status: Status): void {
    this.readout.status(status);
    this.dock?.status(status);
    this.panel.dead(status.dead ?? []);
    this.hint(status);
  }

  changed(key: string, value: Setting, duration: number): void {
    this.panel.changed(key, value, duration);
    if (this.plots && key === THRESHOLD) this.plots.threshold = perAxis(value);
  }

  refused(what: string, reason: string): void {
    const shown = this.panel.refused(what, reason);
    if (!shown || byId("panel").hidden) this.notices.say(`${what}: ${reason}`, "refused");
  }

  done(what: string, detail: string): void {
    this.notices.say(what === "save" ? `Saved as ${detail}` : detail || what, "done");
  }

  lost(retryAt: number | null): void {
    this.notices.lost(retryAt);
    this.readout.lost();
  }

  found(): void {
    this.notices.found();
  }

  /** After each picture. */
  tick(now: number): void {
    const { app } = this;
    if (now - this.drawn > PLOT_EVERY[app.level]) {
      this.plots?.draw();
      this.drawn = now;
    }
    if (app.replay && app.current) this.timeline?.update(app.current.scalar("time"));
    if (now - this.texts < TEXT_EVERY) return;
    this.texts = now;
    this.readout.update(app.current, app.latency.median, app.pace.rate);
    if (app.current) this.panel.thrusts(app.current.list("thrusts"));
  }

  private makePanel(): Panel {
    const { app } = this;
    const own = {
      grabAt: (at: "point" | "centre") => (app.grabAt = at),
      plane: (plane: "facing" | "level") => (app.plane = plane),
      ways: (ways: Ways) => (app.pushes.ways = ways),
      graphics: (level: Choice) => app.setGraphics(level),
      shown: app.shown,
      get strength() {
        return app.pushes.force;
      },
      set strength(newtons: number) {
        app.pushes.force = newtons;
      },
    };
    const asks = {
      set: (key: string, value: Setting) => app.send({ type: "set", key, value }),
      restore: (key: string) => app.send({ type: "restore", key }),
      restoreAll: () => app.send({ type: "restore" }),
      kill: (rotor: number) => {
        app.send({ type: "kill", rotor });
      },
    };
    return new Panel(byId("panel"), own, asks);
  }

  private makeDock(): void {
    const { app } = this;
    const save = saving(
      () => this.mission,
      (name) => {
        app.send({ type: "save", name });
      },
    );
    const film = (): void => {
      this.toggleFilm();
    };
    this.dock = new Dock(byId("dock"), app.send.bind(app), save, film);
  }

  private makeViews(): void {
    const { app } = this;
    const views = choice("Camera", VIEWS, "behind", (view) => {
      app.look(view);
    });
    const follow = toggle("follow", true, (on) => (app.follow.following = on));
    byId("views").replaceChildren(views, follow);
  }

  private toggleFilm(): void {
    let reason = "";
    if (this.film.running) this.film.stop();
    else reason = this.film.start(this.app.canvas, `${this.mission}-${stamp()}`);
    if (reason) this.notices.say(reason, "refused");
    this.dock?.filming(this.film.running);
    byId("dock").classList.toggle("filming", this.film.running);
  }

  /** What to do first, until it was done. */
  private hint(status: Status): void {
    const hint = byId("hint");
    const text = hintOf(status, this.pulled);
    if (hint.textContent !== text) hint.textContent = text;
    hint.hidden = text === "" || this.app.replay !== null;
  }

  private readonly key = (event: KeyboardEvent): void => {
    if (typing(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.repeat && !event.code.startsWith("Arrow")) return;
    this.keys().get(event.code)?.();
  };

  private keys(): Map<string, () => void> {
    const { app, timeline } = this;
    const views = [...byId("views").querySelectorAll<HTMLElement>("button, input")];
    const names = ["Digit1", "Digit2", "Digit3", "KeyF"];
    const keys = new Map(names.map((name, i) => [name, () => views[i].click()]));
    if (timeline) {
      keys.set("KeyP", () => timeline.toggle());
      keys.set("ArrowLeft", () => timeline.step(-1));
      keys.set("ArrowRight", () => timeline.step(1));
    } else {
      keys.set("KeyP", () => this.dock?.pause());
      keys.set("KeyL", () => app.send({ type: "ask", what: "lift" }));
      keys.set("KeyK", () => app.send({ type: "ask", what: "land" }));
    }
    return keys;
  }
}

function hintOf({ phase, preparing }: Status, pulled: boolean): string {
  if (preparing?.failure) return `The flight cannot be flown: ${preparing.failure}`;
  if (preparing) return `Preparing the flight: ${preparing.step} \u2026`;
  if (phase === "idle") return "Press Lift to take off.";
  return phase === "guided" && !pulled ? "Drag the beam to pull it." : "";
}

/** A button that shows and hides a part of the page. */
function fold(name: string, part: string, open: boolean): void {
  const [handle, place] = [byId(name), byId(part)];
  const set = (on: boolean): void => {
    handle.setAttribute("aria-pressed", String(on));
    place.hidden = !on;
    document.body.classList.toggle(`no-${part}`, !on);
  };
  handle.addEventListener("click", () => {
    set(place.hidden !== false);
  });
  set(open);
}
