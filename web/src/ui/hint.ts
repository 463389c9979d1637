// What a person can do first, or why nothing moves.

import type { Phase, StatusMessage, StatusRefusals } from "../wire/messages.generated.ts";
import { isAirborne } from "./phases.ts";

const HELD: Phase[] = ["hold", "contact", "limited"]; // phases in which a pilot does not follow, and says why

export function hintOf({ phase, preparing, refusals, holder, tare_left_s: tare }: StatusMessage, pulled: boolean): string {
  if (preparing?.failure) return `The flight cannot be flown: ${preparing.failure}`;
  if (preparing) return `Preparing the flight: ${preparing.step} \u2026`;
  if (tare > 0 && isAirborne(phase)) return `Zeroing the force sensors: do not touch for ${tare.toFixed(1)} s`;
  if (phase === "idle") return refusals.lift ? onGround(refusals) : "Press Lift to take off.";
  if (HELD.includes(phase)) return holder === "none" ? refusals.push : ""; // else it is said at the hand
  return phase === "guided" && !pulled ? "Drag the beam to pull it." : "";
}

/** Why a vehicle on the ground may not lift; nothing if it takes no requests, for then it lifts by itself. */
function onGround({ lift, land }: StatusRefusals): string {
  const reason = (sentence: string): string => sentence.slice(sentence.indexOf(":"));
  return reason(lift) === reason(land) ? "" : lift;
}
