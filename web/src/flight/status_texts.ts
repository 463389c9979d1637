// What is said of a flight: why it was stopped, and what the pilot would refuse right now. The words come from Python.

import type { SceneEnding, StatusRefusals } from "../wire/messages.generated.ts";
import type { Flight } from "./flight.ts";
import type { PageManifest, Span } from "./manifest.ts";
import type { FlightModule } from "./module.ts";
import { filled } from "./refusal.ts";

/** The ending of a flight; null while it goes on. */
export function endingOf(module: FlightModule, page: PageManifest, flight: Flight): SceneEnding | null {
  if (!flight.lost) return null;
  const [number, time, value, notFinite, x, y, z] = found(module, "ending", page.ending, flight);
  const { by_number: known, not_finite: parts } = page.texts.endings;
  const { outcome, text } = notFinite ? parts[notFinite - 1] : known[String(number)];
  const place = [x, y, z].every(Number.isFinite) ? ([x, y, z] as const) : null;
  return { outcome, text: filled(text, { time, value, rounded: Number(value.toPrecision(3)) }), time, place };
}

export function refusalsNow(module: FlightModule, page: PageManifest, flight: Flight): StatusRefusals {
  const numbers = [...found(module, "refusals", page.guidance, flight)];
  const sentence = (request: keyof StatusRefusals, i: number): string => {
    const [number, value, limit] = numbers.slice(3 * i, 3 * i + 3);
    return filled(page.texts.refusals[request][number], { value, limit, alarm: page.scene.alarms[value] ?? "" });
  };
  return { lift: sentence("lift", 0), land: sentence("land", 1), push: sentence("push", 2) };
}

/** What a function returns of parts of a flight's numbers, and its time. */
function found(module: FlightModule, name: string, parts: readonly Span[], flight: Flight): Float64Array {
  return module.values(name, [...parts.flatMap(([at, size]) => [...flight.numbersAt(at, size)]), flight.time]);
}
