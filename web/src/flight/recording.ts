// A flight as files that `tandemlift run` flies again. As `simulation.recorded_flight` writes them.

import { strToU8 } from "fflate";
import { stringify } from "smol-toml";

import { type Files, npy, npyOfText, zip } from "./archive.ts";
import type { Flight } from "./flight.ts";
import type { StatusScore } from "../wire/messages.generated.ts";
import type { PageManifest, Tables } from "./manifest.ts";
import { Refusal } from "./refusal.ts";

/** A change in flight, as a mission's `[[changes]]` has it. */
export interface RecordedChange extends Tables {
  time: number;
  key: string;
  value: number | readonly number[];
  duration: number;
}

const LAST = "last_sample.npy"; // the last sample as it was in the page: flown again, it is the same

/** An archive with mission, hand, last sample, and the score if it has one; it ends at the beginning of the flight's last step. */
export function recordedFlight(
  name: string,
  flight: Flight,
  page: PageManifest,
  start: Tables,
  changes: readonly RecordedChange[],
  score: StatusScore | null,
): Uint8Array<ArrayBuffer> {
  if (flight.step < 2) throw new Refusal(page.texts.empty);
  const steps = flight.lost ? flight.step : flight.step - 1;
  const entries = flight.recorded.filter((entry) => entry.step <= steps);
  const width = page.released.length;
  const hands = new Float64Array(entries.length * width);
  entries.forEach((entry, i) => hands.set(entry.hand, i * width));
  const hand = zip({
    "step.npy": npy(BigInt64Array.from(entries, (entry) => BigInt(entry.step)), "<i8"),
    "hand.npy": npy(hands, "<f8", [entries.length, width]),
    "engine.npy": npyOfText(page.engine),
  });
  const text = strToU8(missionText(name, steps, page, start, changes));
  const files = { [page.files.mission]: text, [page.files.hand]: hand, [LAST]: npy(flight.sample, "<f8") };
  return zip({ ...files, ...(score && scoreFile(score, page.files.score)) });
}

/** The score of a run that is ranked, as `tandemlift score` reads it; no file of one that is not. */
function scoreFile({ finished, refused, time, touches, effort, jerk, score }: StatusScore, name: string): Files {
  if (!finished || refused) return {};
  return { [name]: strToU8(JSON.stringify({ time, touches, effort, jerk, score }, null, 1)) };
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
  return `# Flies again: tandemlift run ${page.files.mission}\n\n${stringify(tables)}`;
}
