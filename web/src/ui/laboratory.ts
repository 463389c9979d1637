// The flight over time: plots, a timeline with what happened, and the moment that a person chose.

import type { Graphics } from "../view/graphics.ts";
import type { Frame } from "../wire/frames.ts";
import type { PageMessage, ParameterValue, StatusMessage, Vector } from "../wire/messages.generated.ts";
import { THRESHOLD } from "../wire/messages.generated.ts";
import { perAxis } from "../wire/parameters.ts";
import type { Replay } from "../wire/replay.ts";
import type { FlownScene } from "../wire/source.ts";
import { button, byId, el } from "./dom.ts";
import { History } from "./history.ts";
import { Marks } from "./marks.ts";
import { worded } from "./numbers.ts";
import { Plots } from "./plots.ts";
import { TimeWindow } from "./time_window.ts";
import { Timeline } from "./timeline.ts";

const PLOT_EVERY = { full: 30, light: 110 }; // ms; each of the four plots is drawn at a fourth of this rate
const BACK = 5; // s, that a flight is rewound if no moment is chosen
const REWIND = `Fly again to the chosen moment, or ${BACK} s back, and stand still there (R)`;
const TIMELINE_EVERY = 100; // ms

/** What the laboratory needs of the page. */
export interface LaboratoryPage {
  readonly replay: Replay | null;
  readonly graphics: Graphics;
  readonly current: Frame | null;
  send(message: PageMessage): void;
}

export class Laboratory {
  readonly timeline: Timeline;
  private readonly window: TimeWindow;
  private scene: FlownScene | null = null;
  private history: History | null = null;
  private plots: Plots | null = null;
  private marks = new Marks();
  private drawn = 0; // ms
  private told = 0; // ms
  private readonly clock = el("output", {});
  private readonly back: HTMLButtonElement;

  constructor(
    private readonly page: LaboratoryPage,
    private readonly tell: (text: string) => void,
  ) {
    this.window = new TimeWindow(
      () => this.history!.flown,
      () => page.current?.scalar("time") ?? NaN,
    );
    this.timeline = new Timeline((time) => this.choose(time));
    this.back = button("play", "Now", "The last seconds, and no chosen moment", () => {
      this.window.follow();
      this.choose(null);
    });
    const again = button("rewind", "Rewind", REWIND, () => this.rewind());
    if (!page.replay) byId("time").replaceChildren(this.clock, this.timeline.element, this.back, again);
  }

  /** The threshold of pushes along each axis [N]; null before the first scene. */
  get threshold(): Vector | null {
    return this.plots?.threshold ?? null;
  }

  /** Plots of what was flown: of the whole of a replay, else what frames show from now on. */
  show(scene: FlownScene): void {
    const { replay, graphics } = this.page;
    if (!this.history?.continue(scene)) [this.history, this.marks] = [new History(scene), new Marks()];
    this.scene = scene;
    if (replay) for (const frame of replay.frames()) this.keep(frame);
    this.marks.findings(scene.replay?.findings ?? []);
    for (const { time, text } of scene.replay?.changes ?? []) this.marks.setting(time, text);
    const chose = (time: number): void => this.choose(time);
    const before = this.plots;
    before?.remove();
    const place = byId("plots");
    this.plots = new Plots(scene, place, graphics, this.history, this.window, this.marks, chose, before?.asError);
  }

  frame(frame: Frame): void {
    if (!this.page.replay) this.keep(frame);
  }

  status({ findings }: StatusMessage): void {
    if (findings) this.marks.findings(findings);
  }

  changed(key: string, value: ParameterValue): void {
    const { page, scene, plots } = this;
    if (plots && key === THRESHOLD) plots.threshold = perAxis(value);
    const parameter = scene?.parameters.find((one) => one.key === key);
    const text = `${parameter?.label ?? key} \u2192 ${worded(value)} ${parameter?.unit ?? ""}`;
    if (page.current) this.marks.setting(page.current.scalar("time"), text.trim());
  }

  /** Has the flight flown again to the chosen moment. */
  rewind(): void {
    const { window, page } = this;
    if (!page.current) return;
    const time = window.moment ?? Math.max(page.current.scalar("time") - BACK, 0);
    page.send({ type: "rewind", time });
    this.tell(`Flown again to ${time.toFixed(2)} s, it stands still: take hold, then press Continue (P).`);
  }

  /** After each picture. */
  tick(now: number): void {
    const { page, window, scene, history } = this;
    if (now - this.drawn > PLOT_EVERY[page.graphics]) {
      this.plots?.draw();
      this.drawn = now;
    }
    if (now - this.told < TIMELINE_EVERY || !page.current || !scene || !history) return;
    this.told = now;
    const present = page.current.scalar("time");
    const value = page.replay ? present : (window.moment ?? present);
    this.timeline.update(history.flown, window.shown, value, this.marks, scene.phases);
    this.clock.textContent = `${value.toFixed(2)} s`;
    this.back.hidden = window.moment === null && !window.isZoomed;
  }

  /** A moment is chosen, in a plot or on the timeline. */
  private choose(time: number | null): void {
    if (time !== null) this.page.replay?.seek(time);
    this.window.choose(time);
    this.plots?.point();
  }

  private keep(frame: Frame): void {
    if (this.history!.add(frame)) {
      this.window.restart();
      this.marks.cut(frame.scalar("time"));
    }
    this.marks.frame(frame);
  }
}
