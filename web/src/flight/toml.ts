// Nested tables as TOML. Numbers are written so that reading them gives the same double.

export type TomlValue = number | string | boolean | readonly TomlValue[] | Tables;
export interface Tables {
  [key: string]: TomlValue;
}

export function isTable(value: TomlValue | undefined): value is Tables {
  return typeof value === "object" && !Array.isArray(value);
}

function isListOfTables(value: TomlValue): value is readonly Tables[] {
  return Array.isArray(value) && value.length > 0 && value.every((one) => isTable(one as TomlValue));
}

const written = (key: string): string => (/^[\w-]+$/.test(key) ? key : JSON.stringify(key));

function inline(value: TomlValue): string {
  if (typeof value === "number") return Number.isFinite(value) && value !== 0 ? String(value) : odd(value);
  if (typeof value !== "object") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map((one) => inline(one as TomlValue)).join(", ")}]`;
  const entries = Object.entries(value as Tables).map(([key, one]) => `${written(key)} = ${inline(one)}`);
  return `{ ${entries.join(", ")} }`;
}

/** A number that is 0 or not finite. */
function odd(value: number): string {
  if (value === 0) return Object.is(value, -0) ? "-0.0" : "0";
  return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

/** Tables as text; a number without fraction has none, which stands for the same double. */
export function toml(tables: Tables, path: readonly string[] = []): string {
  const entries = Object.entries(tables);
  const own = entries.filter(([, value]) => !isTable(value) && !isListOfTables(value));
  const lines = own.map(([key, value]) => `${written(key)} = ${inline(value)}\n`);
  const parts = entries.flatMap(([key, value]) => {
    const name = [...path, written(key)].join(".");
    if (isTable(value)) return [`\n[${name}]\n${toml(value, [...path, written(key)])}`];
    if (!isListOfTables(value)) return [];
    return value.map((one) => `\n[[${name}]]\n${toml(one, [...path, written(key)])}`);
  });
  return lines.join("") + parts.join("");
}
