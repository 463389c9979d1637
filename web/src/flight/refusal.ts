// Why a message is refused. The texts come from Python, with names in braces where values go.

export class Refusal extends Error {
  constructor(text: string, values: Record<string, number | string> = {}) {
    super(filled(text, values));
  }
}

/** A text with its values; numbers with six digits at most. */
export function filled(text: string, values: Record<string, number | string>): string {
  return text.replace(/\{(\w+)\}/g, (all, name: string) => {
    const value = values[name] ?? all;
    return typeof value === "number" ? String(Number(value.toPrecision(6))) : value;
  });
}

const LONGEST = 70;

/** A value on one line of bounded length. */
export function shown(value: unknown): string {
  const text = JSON.stringify(value);
  return text.length <= LONGEST ? text : `${text.slice(0, LONGEST - 1)}\u2026`;
}
