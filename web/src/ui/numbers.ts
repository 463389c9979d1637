// Numbers as text, and the scales of sliders.

import type { ParameterValue } from "../wire/messages.generated.ts";

/** A number with four figures at most. */
export function formatNumber(value: number): string {
  if (value === 0 || !Number.isFinite(value)) return String(value);
  return String(Number(value.toPrecision(4)));
}

/** The scale of a slider from 0 to 1000; logarithmic if high / low is above 60. */
export class SliderScale {
  private readonly logarithmic: boolean;

  constructor(
    private readonly low: number,
    private readonly high: number,
  ) {
    this.logarithmic = low > 0 && high / low > 60;
  }

  place(value: number): number {
    const bounded = Math.min(Math.max(value, this.low), this.high);
    const fraction = this.logarithmic
      ? Math.log(bounded / this.low) / Math.log(this.high / this.low)
      : (bounded - this.low) / (this.high - this.low);
    return Math.round(1000 * fraction);
  }

  /** The value at a place, with three figures or as many as tell it from those beside it. */
  value(place: number): number {
    const fraction = place / 1000;
    const { low, high } = this;
    const raw = this.logarithmic ? low * (high / low) ** fraction : low + fraction * (high - low);
    const rounded = [3, 4, 5, 6].map((figures) => Number(raw.toPrecision(figures)));
    return rounded.find((value) => value >= low && value <= high && this.place(value) === place) ?? raw;
  }
}

/** A value of a parameter in words; one number for all of a list that are the same. */
export function worded(value: ParameterValue): string {
  const parts = [value].flat().map((one) => (typeof one === "number" ? formatNumber(one) : String(one)));
  return [...new Set(parts)].length === 1 ? parts[0] : parts.join(", ");
}
