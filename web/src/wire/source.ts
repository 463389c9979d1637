// Where a flight comes from: a server, or the page itself. The rest of the page does not know which.

import type { Frame } from "./frames.ts";
import type { FlightScene, PageMessage, ParameterValue, StatusMessage } from "./messages.generated.ts";

export interface FlightListener {
  scene(scene: FlightScene): void;
  frame(frame: Frame): void;
  status(status: StatusMessage): void;
  changed(key: string, value: ParameterValue, duration: number): void;
  refused(what: string, reason: string): void;
  done(what: string, detail: string): void;
  connected(): void;
  disconnected(retryAt: number): void; // ms, by the page's clock
}

export interface FlightSource {
  start(listener: FlightListener): void;
  /** Sends a message; its number, or null if it cannot be sent. */
  send(message: PageMessage): number | null;
  /** Before each picture: a source that keeps its own time moves on. */
  tick?(now: number): void;
  retry?(): void;
}
