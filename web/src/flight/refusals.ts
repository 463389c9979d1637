// What the pilot would refuse right now, in words. As `live.session.status` does it.

import type { StatusRefusals } from "../wire/messages.generated.ts";
import type { Flight } from "./flight.ts";
import type { PageManifest } from "./manifest.ts";
import type { FlightModule } from "./module.ts";
import { filled, general } from "./python_text.ts";

export function refusalsNow(module: FlightModule, page: PageManifest, flight: Flight): StatusRefusals {
  const given = page.guidance.flatMap(([at, size]) => [...flight.numbersAt(at, size)]);
  const found = [...module.values("refusals", [...given, flight.time])];
  const sentence = (request: keyof StatusRefusals, i: number): string => {
    const [number, value, limit] = found.slice(3 * i, 3 * i + 3);
    const alarm = page.scene.alarms[value] ?? "";
    return filled(page.texts.refusals[request][number], { value: general(value), limit: general(limit), alarm });
  };
  return { lift: sentence("lift", 0), land: sentence("land", 1), push: sentence("push", 2) };
}
