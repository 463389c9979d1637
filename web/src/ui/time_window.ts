// The stretch of time that all plots show, and the moment at which they show values.

export const SPAN = 20; // s, the last ones, which are shown unless a person zooms
const LEAST = 0.2; // s

export type Stretch = readonly [from: number, to: number];

/** A stretch made larger by a factor; a time stays in its place. */
export function zoomed([from, to]: Stretch, around: number, factor: number): Stretch {
  return [around + (from - around) * factor, around + (to - around) * factor];
}

/** The stretch in which two times lie at two places, as fractions of its length. */
export function pinched([early, late]: Stretch, [left, right]: Stretch): Stretch {
  const length = (late - early) / Math.max(right - left, 1e-3);
  return [early - left * length, early + (1 - left) * length];
}

/** A stretch moved, and shortened if need be, into what was flown; at least as long as can be read. */
export function within([from, to]: Stretch, [first, last]: Stretch): Stretch {
  const most = Math.max(last - first, LEAST);
  const length = Math.min(Math.max(to - from, LEAST), most);
  const middle = (from + to) / 2;
  const start = Math.min(Math.max(middle - length / 2, first), Math.max(last - length, first));
  return [start, start + length];
}

export class TimeWindow {
  hovered: number | null = null; // s, under a mouse
  moment: number | null = null; // s, that a person chose
  private zoomedTo: Stretch | null = null;
  private held: Stretch | null = null;

  /** `flown`: what is kept; `now`: the time of the picture. */
  constructor(
    private readonly flown: () => Stretch,
    private readonly now: () => number,
  ) {}

  get shown(): Stretch {
    const now = this.now();
    return this.held ?? this.zoomedTo ?? [now - SPAN, now];
  }

  /** The time at which values are shown. */
  get cursor(): number | null {
    return this.hovered ?? this.moment;
  }

  get isZoomed(): boolean {
    return this.zoomedTo !== null;
  }

  zoom(stretch: Stretch): void {
    this.zoomedTo = within(stretch, this.flown());
  }

  /** Back to the last seconds. */
  follow(): void {
    this.zoomedTo = this.held = null;
  }

  /** Stands still while a person drags over it, although the flight goes on. */
  hold(): void {
    this.held = this.shown;
  }

  release(): void {
    this.held = null;
  }

  /** A moment is chosen; it is brought into view. */
  choose(time: number | null): void {
    this.moment = time;
    if (time === null) return;
    const [from, to] = this.shown;
    if (time < from || time > to) this.zoom([time - (to - from) / 2, time + (to - from) / 2]);
  }

  /** The flight is another one from here on. */
  restart(): void {
    this.moment = this.hovered = null;
    this.follow();
  }
}
