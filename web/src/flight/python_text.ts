// Values as Python writes them in its messages.

/** A double as Python's `str` gives it: the same digits as here, with another exponent. */
export function float(x: number): string {
  if (!Number.isFinite(x)) return Number.isNaN(x) ? "nan" : x > 0 ? "inf" : "-inf";
  if (Object.is(x, -0)) return "-0.0";
  const [digits, power] = x.toExponential().split("e");
  const exponent = Number(power);
  if (exponent < -4 || exponent >= 16) return `${digits}e${exponent < 0 ? "-" : "+"}${pad(exponent)}`;
  const plain = String(x);
  return plain.includes(".") ? plain : `${plain}.0`;
}

const pad = (exponent: number): string => String(Math.abs(exponent)).padStart(2, "0");

/** A number as Python's format `g` gives it, with six figures. */
export function general(x: number): string {
  if (x === 0) return Object.is(x, -0) ? "-0" : "0";
  if (!Number.isFinite(x)) return float(x);
  const [digits, power] = x.toExponential(5).split("e");
  const exponent = Number(power);
  const trimmed = (text: string): string => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);
  if (exponent < -4 || exponent >= 6) return `${trimmed(digits)}e${exponent < 0 ? "-" : "+"}${pad(exponent)}`;
  return trimmed(x.toFixed(Math.max(0, 5 - exponent)));
}

const LONGEST = 70;

/** A value as one would write it in TOML, on one line of bounded length. */
export function shown(value: unknown): string {
  const text = writtenOut(value);
  return text.length <= LONGEST ? text : `${text.slice(0, LONGEST - 1)}\u2026`;
}

function writtenOut(value: unknown): string {
  if (typeof value === "number") return float(value);
  if (Array.isArray(value)) return `[${value.slice(0, 40).map(writtenOut).join(", ")}]`;
  return JSON.stringify(typeof value === "string" ? value.slice(0, 100) : value);
}

/** A text with values in place of the names in braces. */
export function filled(text: string, values: Record<string, string>): string {
  return text.replace(/\{(\w+)\}/g, (all, name: string) => values[name] ?? all);
}
