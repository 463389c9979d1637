// What goes between the page and the worker that flies.

import type { PageMessage, ServerMessage } from "../wire/messages.generated.ts";
import type { Comparing, FlownStatus } from "../wire/source.ts";
import type { Setting } from "./link.ts";
import type { FlightIndex, MissionEntry } from "./manifest.ts";
import type { SavedFile, SceneAnswer } from "./session.ts";

/** To the worker: the flight to open, before anything else; or one that flies along as a ghost. */
export interface OpenRequest {
  type: "open" | "along";
  index: FlightIndex;
  entry: MissionEntry;
  settings: Setting[];
  file: ArrayBuffer | null; // the flight, compressed, if it is a file
}

export interface CompareRequest {
  type: "compare";
  what: Exclude<Comparing, "fly">;
}

export type ToWorker = OpenRequest | CompareRequest | (PageMessage & { seq: number });

/** From the worker: a frame, a file, or what a server would say. */
export type FromWorker =
  | { type: "frame"; values: Float32Array<ArrayBuffer> }
  | SavedFile
  | SceneAnswer
  | FlownStatus
  | Exclude<ServerMessage, { type: "scene" | "status" }>;
