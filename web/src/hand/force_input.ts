// Pushes with a set force at the centre of mass, by keyboard or gamepad.

import { type PerspectiveCamera, Vector3 } from "three";

import { add, levelDirections, scale, size, subtract } from "../math/vectors.ts";
import type { PageMessage, Vector } from "../wire/messages.generated.ts";
import type { HandOptions } from "./options.ts";

// forward, left, up
const KEYS: Record<string, Vector> = {
  ArrowUp: [1, 0, 0],
  KeyW: [1, 0, 0],
  ArrowDown: [-1, 0, 0],
  KeyS: [-1, 0, 0],
  ArrowLeft: [0, 1, 0],
  KeyA: [0, 1, 0],
  ArrowRight: [0, -1, 0],
  KeyD: [0, -1, 0],
  KeyE: [0, 0, 1],
  PageUp: [0, 0, 1],
  KeyQ: [0, 0, -1],
  PageDown: [0, 0, -1],
};
const DEAD_ZONE = 0.15; // of a stick's travel
const STILL = 0.02; // N: a smaller change is not sent
const ASK_AGAIN = 200; // ms after a refusal
export const TAP = 0.05; // s

/** Of a message of a force: how it swings. */
export const shaken = ({ kind, frequency }: HandOptions): { frequency?: number } => (kind === "shake" ? { frequency } : {});

export class ForceInput {
  private readonly pressed = new Set<string>();
  private sent: Vector = [0, 0, 0];
  private stamp = 0;
  private askAgain = 0; // ms

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly options: HandOptions,
    private readonly send: (message: PageMessage, since: number) => unknown,
    private readonly listening: boolean,
  ) {
    if (!listening) return;
    window.addEventListener("keydown", this.down);
    window.addEventListener("keyup", this.up);
    window.addEventListener("blur", this.release);
    document.addEventListener("visibilitychange", this.release);
  }

  /** Once per picture: sends the force if it has changed; none while the mouse pulls. */
  flush(pulling: boolean): void {
    if (!this.listening) return;
    const force = pulling ? ([0, 0, 0] as const) : this.inWorld(this.input());
    const ended = size(force) === 0 && size(this.sent) > 0;
    if (!ended && (size(subtract(force, this.sent)) < STILL || performance.now() < this.askAgain)) return;
    this.sent = force;
    this.send({ type: "force", force, point: [0, 0, 0], ...shaken(this.options) }, this.stamp || performance.now());
    this.stamp = 0;
  }

  /** The last force was refused; the next one is sent a moment later. */
  refuse(): void {
    this.askAgain = performance.now() + ASK_AGAIN;
  }

  release = (): void => {
    this.pressed.clear();
    this.flush(true);
  };

  /** Force forward, left and up of the keys and the first gamepad [N]. */
  private input(): Vector {
    let sum: Vector = document.hasFocus() ? stick() : [0, 0, 0];
    for (const key of this.pressed) sum = add(sum, KEYS[key]);
    return scale(sum, this.options.force / Math.max(size(sum), 1));
  }

  private inWorld([ahead, left, up]: Vector): Vector {
    if (this.options.directions === "world" || (ahead === 0 && left === 0)) return [ahead, left, up];
    const looking = this.camera.getWorldDirection(new Vector3()).toArray();
    const upward = new Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion).toArray();
    const [forward, leftward] = levelDirections(looking, upward);
    return add(add(scale(forward, ahead), scale(leftward, left)), [0, 0, up]);
  }

  private readonly down = (event: KeyboardEvent): void => {
    if (event.key === "Meta") this.pressed.clear(); // while it is down, the browser reports no key that goes up
    if (!(event.code in KEYS) || event.ctrlKey || event.metaKey || event.altKey || typing(event)) return;
    event.preventDefault();
    if (this.options.kind === "tap") {
      const force = this.inWorld(scale(KEYS[event.code], this.options.force));
      if (!event.repeat) this.send({ type: "force", force, point: [0, 0, 0], duration: TAP }, event.timeStamp);
      return;
    }
    this.stamp ||= event.timeStamp;
    this.pressed.add(event.code);
  };

  private readonly up = (event: KeyboardEvent): void => {
    if (this.pressed.delete(event.code)) this.stamp ||= event.timeStamp;
  };
}

/** Whether a key belongs to an input that a person is filling in; those of a checkbox and of a slider are few. */
export function typing({ target, code }: KeyboardEvent): boolean {
  if (!(target instanceof HTMLElement)) return false;
  const slides = target.matches("input[type=range]") && /^(Arrow|Page|Home|End)/.test(code);
  return slides || target.closest("input:not([type=checkbox], [type=range]), select, textarea, dialog") !== null;
}

/** Forward, left, up of the first gamepad: left stick level, right stick up and down. */
function stick(): Vector {
  const pad = navigator.getGamepads().find((one) => one?.connected);
  const axis = (i: number): number => {
    const value = pad?.axes[i] ?? 0;
    return Math.abs(value) < DEAD_ZONE ? 0 : -Math.sign(value) * ((Math.abs(value) - DEAD_ZONE) / (1 - DEAD_ZONE));
  };
  return [axis(1), axis(0), axis(3)];
}
