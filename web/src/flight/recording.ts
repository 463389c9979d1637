// A flight as files that `tandemlift run` flies again. As `simulation.recorded_flight` writes them.

import { npyOfDoubles, npyOfIntegers, npyOfText, zip } from "./archive.ts";
import type { Flight } from "./flight.ts";
import type { PageManifest } from "./manifest.ts";
import { Refusal } from "./refusal.ts";
import { type Tables, toml } from "./toml.ts";

/** A change in flight, as a mission's `[[changes]]` has it. */
export interface RecordedChange extends Tables {
  time: number;
  key: string;
  value: number | readonly number[];
  duration: number;
}

const LAST = "last_sample.npy"; // the last sample as it was in the page: flown again, it is the same

/** An archive with mission, hand and last sample; it ends at the beginning of the flight's last step. */
export function recordedFlight(
  name: string,
  flight: Flight,
  page: PageManifest,
  start: Tables,
  changes: readonly RecordedChange[],
): Uint8Array<ArrayBuffer> {
  if (flight.step < 2) throw new Refusal(page.texts.empty);
  const steps = flight.lost ? flight.step : flight.step - 1;
  const entries = flight.recorded.filter((entry) => entry.step <= steps);
  const hand = zip({
    "step.npy": npyOfIntegers(entries.map((entry) => entry.step)),
    "hand.npy": npyOfDoubles(
      entries.flatMap((entry) => [...entry.hand]),
      [entries.length, page.released.length],
    ),
    "engine.npy": npyOfText(page.engine),
  });
  const text = new TextEncoder().encode(missionText(name, steps, page, start, changes));
  const last = npyOfDoubles([...flight.sample], [flight.sample.length]);
  return zip({ [page.files.mission]: text, [page.files.hand]: hand, [LAST]: last });
}

function missionText(
  name: string,
  steps: number,
  page: PageManifest,
  start: Tables,
  changes: readonly RecordedChange[],
): string {
  const mission = start["mission"] as Tables;
  const step = mission["step"] as number;
  const tables = {
    ...start,
    mission: { ...mission, name, duration: steps * step },
    person: { ...(start["person"] as Tables), recording: page.files.hand },
    changes: changes.filter(({ time }) => Math.round(time / step) <= steps),
  };
  return `# Flies again: tandemlift run ${page.files.mission}\n\n${toml(tables)}`;
}
