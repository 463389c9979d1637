// A mission as it is now: its tables and its numbers by their keys.

import { same } from "../wire/parameters.ts";
import type { FlightManifest, Tables, TomlValue } from "./manifest.ts";

export type Value = number | readonly number[];

export class MissionNumbers {
  private readonly places = new Map<string, number>();

  constructor(
    private readonly manifest: FlightManifest,
    readonly tables: Tables = structuredClone(manifest.page.tables),
    readonly numbers: number[] = manifest.module.numbers.map(({ value }) => doubleOf(value)),
  ) {
    manifest.module.numbers.forEach(({ key }, i) => this.places.set(key, i));
  }

  copy(): MissionNumbers {
    return new MissionNumbers(this.manifest, structuredClone(this.tables), [...this.numbers]);
  }

  /** The value of a key of the tables. */
  value(key: string): Value {
    return this.find(key).value as Value;
  }

  /** Whether a value would change the mission; one number stands for all of a list. */
  differs(key: string, value: Value): boolean {
    return !same(this.shaped(key, value), this.value(key));
  }

  /** Sets a key; false if the module does not take it as numbers. */
  set(key: string, value: Value): boolean {
    const shaped = this.shaped(key, value);
    const parts = Array.isArray(shaped) ? (shaped as number[]) : [shaped as number];
    const at = parts.map((_, i) => this.places.get(Array.isArray(shaped) ? `${key}.${i}` : key));
    if (at.some((place) => place === undefined)) return false;
    const { table, last } = this.find(key);
    table[last] = shaped;
    parts.forEach((part, i) => (this.numbers[at[i]!] = part));
    return true;
  }

  /** A value as a list where the key has one; 0 for −0, which a saved mission could not tell apart. */
  private shaped(key: string, value: Value): Value {
    if (typeof value !== "number") return value.map((part) => part + 0);
    const now = this.value(key);
    return typeof now === "number" ? value + 0 : now.map(() => value + 0);
  }

  private find(key: string): { table: Tables; last: string; value: TomlValue } {
    const path = key.split(".");
    const last = path.pop()!;
    const table = path.reduce<Tables>((inner, part) => inner[part] as Tables, this.tables);
    return { table, last, value: table[last] };
  }
}

function doubleOf(value: number | string): number {
  return Number(String(value).replace("inf", "Infinity"));
}
