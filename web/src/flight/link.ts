// A link that holds a mission and settings: page.html#mission=iris&admittance.mass=2&wind.velocity=3,0,0

import type { ParameterValue, SceneParameter } from "../wire/messages.generated.ts";
import { same } from "../wire/parameters.ts";

export type Setting = readonly [key: string, value: number | string | readonly number[]];

export interface Link {
  mission: string | null;
  settings: Setting[];
}

/** What a link says, lists with or without brackets; what is no number stays a text, which is refused where it is set. */
export function readLink(hash: string): Link {
  const entries = [...new URLSearchParams(hash.replace(/^#/, ""))];
  const settings = entries.filter(([key]) => key !== "mission").map(([key, text]) => [key, valueOf(text)] as const);
  return { mission: entries.find(([key]) => key === "mission")?.[1] ?? null, settings };
}

/** The link of a mission with the parameters that differ from the mission's own. */
export function linkOf(mission: string, parameters: readonly SceneParameter[]): string {
  const altered = parameters.filter(({ value, initial }) => !same(value, initial ?? value));
  const entries = altered.map(({ key, value }) => `${key}=${encodeURIComponent(textOf(value)).replaceAll("%2C", ",")}`);
  return `#${[`mission=${encodeURIComponent(mission)}`, ...entries].join("&")}`;
}

const textOf = (value: ParameterValue): string => [value].flat().join(",");

function valueOf(text: string): number | string | readonly number[] {
  const list = text.trim().replace(/^\[(.*)\]$/, "$1");
  const parts = list.split(",").map((part) => (part.trim() === "" ? Number.NaN : Number(part)));
  if (!parts.every(Number.isFinite)) return text;
  return parts.length === 1 && list === text.trim() ? parts[0] : parts;
}
