// What goes between the page and the worker that flies.

import type { PageMessage, ServerMessage } from "../wire/messages.generated.ts";
import type { Setting } from "./link.ts";
import type { FlightIndex, MissionEntry } from "./manifest.ts";
import type { SavedFile } from "./session.ts";

/** To the worker: the flight to open, before anything else. */
export interface OpenRequest {
  type: "open";
  index: FlightIndex;
  entry: MissionEntry;
  settings: Setting[];
  file: ArrayBuffer | null; // the flight, compressed, if it is a file
}

export type ToWorker = OpenRequest | (PageMessage & { seq: number });

/** From the worker: a frame, a file, or what a server would say. */
export type FromWorker = { type: "frame"; values: Float32Array<ArrayBuffer> } | SavedFile | ServerMessage;
