// Numbers for people: short, and sliders that are fine where the values are small.

/** A number with four figures at most. */
export function short(value: number): string {
  if (value === 0 || !Number.isFinite(value)) return String(value);
  return String(Number(value.toPrecision(4)));
}

/** A slider from 0 to 1000 over a range; by ratio if the range spans more than two decades. */
export class Slide {
  private readonly byRatio: boolean;

  constructor(
    private readonly low: number,
    private readonly high: number,
  ) {
    this.byRatio = low > 0 && high / low > 60;
  }

  place(value: number): number {
    const bounded = Math.min(Math.max(value, this.low), this.high);
    const share = this.byRatio
      ? Math.log(bounded / this.low) / Math.log(this.high / this.low)
      : (bounded - this.low) / (this.high - this.low);
    return Math.round(1000 * share);
  }

  value(place: number): number {
    const share = place / 1000;
    const raw = this.byRatio ? this.low * (this.high / this.low) ** share : this.low + share * (this.high - this.low);
    return Number(raw.toPrecision(3));
  }
}
