// Where a flight comes from: a server, or the page itself. The rest of the page does not know which.

import type { Frame } from "./frames.ts";
import type {
  FlightScene,
  PageMessage,
  ParameterValue,
  SceneMission,
  SceneParameter,
  StatusMessage,
} from "./messages.generated.ts";

/** What a page does with a ghost: keeps the flight as it is, flies another mission along, swaps, or ends it. */
export type Comparing = "keep" | "fly" | "swap" | "end";
export type Compare = (what: Comparing, mission?: string) => void;

/** The ghost of a scene: what it flies, and the numbers of ghosts begun and of changes of places so far. */
export interface SceneGhost {
  mission: string;
  controller: string;
  parameters: SceneParameter[];
  begun: number;
  swaps: number;
}

/** A scene in which a ghost may fly along under the same hand. */
export interface FlownScene extends FlightScene {
  ghost?: SceneGhost;
}

/** A status with how the ghost has ended; empty while it flies. */
export interface FlownStatus extends StatusMessage {
  ghost?: string;
}

export interface FlightListener {
  scene(scene: FlownScene): void;
  frame(frame: Frame): void;
  status(status: FlownStatus): void;
  changed(key: string, value: ParameterValue, duration: number): void;
  refused(what: string, reason: string): void;
  done(what: string, detail: string): void;
  connected(): void;
  disconnected(retryAt: number): void; // ms, by the page's clock
}

export interface FlightSource {
  /** Missions that may fly along as a ghost; absent where none can, not even the same. */
  readonly companions?: readonly SceneMission[];
  start(listener: FlightListener): void;
  /** Sends a message; its number, or null if it cannot be sent. */
  send(message: PageMessage): number | null;
  compare?: Compare;
  /** Before each picture: a source that keeps its own time moves on. */
  tick?(now: number): void;
  retry?(): void;
}
