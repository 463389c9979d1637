// Why a flight was stopped before its end, in words. As `simulation.outcome` says it.

import type { StatusEnding } from "../wire/messages.generated.ts";
import type { Flight } from "./flight.ts";
import type { EndingText, PageManifest } from "./manifest.ts";
import type { FlightModule } from "./module.ts";
import { filled, general } from "./python_text.ts";

export interface KnownEnding extends StatusEnding {
  outcome: EndingText["outcome"];
}

/** The ending of a flight; null while it goes on. */
export function endingOf(module: FlightModule, page: PageManifest, flight: Flight): KnownEnding | null {
  if (!flight.lost) return null;
  const given = page.ending.flatMap(([at, size]) => [...flight.numbersAt(at, size)]);
  const [number, time, value, notFinite, x, y, z] = module.values("ending", [...given, flight.time]);
  const { by_number: known, not_finite: parts } = page.texts.endings;
  const { outcome, text } = notFinite ? parts[notFinite - 1] : known[String(number)];
  const place = [x, y, z].every(Number.isFinite) ? ([x, y, z] as const) : null;
  return { outcome, text: filled(text, { time: general(time), value: general(value) }), time, place };
}
