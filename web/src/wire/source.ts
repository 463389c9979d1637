// Where a flight comes from: a server, or the page itself. The rest of the page does not know which.

import type { Frame } from "./frames.ts";
import type { Outgoing, Scene, Setting, Status } from "./protocol.ts";

export interface Listener {
  scene(scene: Scene): void;
  frame(frame: Frame): void;
  status(status: Status): void;
  changed(key: string, value: Setting, duration: number): void;
  refused(what: string, reason: string): void;
  done(what: string, detail: string): void;
  lost(retryAt: number | null): void;
  found(): void;
}

export interface Source {
  start(listener: Listener): void;
  /** Sends a message; its number, or null if nobody can hear it. */
  send(message: Outgoing): number | null;
  /** Before each picture: a source that keeps its own time moves on. */
  tick?(now: number): void;
  retry?(): void;
}
