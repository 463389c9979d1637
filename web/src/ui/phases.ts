// The phases of a flight in words and colours.

import type { Phase, StatusMessage } from "../wire/messages.generated.ts";

interface PhaseLook {
  text: string;
  kind: "calm" | "active" | "moving" | "fault" | "off";
  tint: string;
}

const LOOKS: Record<Phase, PhaseLook> = {
  preparing: { text: "preparing", kind: "off", tint: "rgba(0, 0, 0, 0)" },
  idle: { text: "on the ground", kind: "off", tint: "rgba(93, 104, 117, 0.10)" },
  lift: { text: "lifting", kind: "moving", tint: "rgba(240, 180, 41, 0.16)" },
  guided: { text: "follows pushes", kind: "active", tint: "rgba(31, 157, 118, 0.13)" },
  land: { text: "landing", kind: "moving", tint: "rgba(240, 180, 41, 0.16)" },
  hold: { text: "holding", kind: "calm", tint: "rgba(47, 111, 176, 0.12)" },
  contact: { text: "touching a wall", kind: "moving", tint: "rgba(240, 180, 41, 0.16)" },
  crashed: { text: "crashed", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
  diverged: { text: "out of control", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
  over: { text: "over: press Reset", kind: "off", tint: "rgba(93, 104, 117, 0.10)" },
  failed: { text: "failed: press Reset", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
  limited: { text: "cannot follow", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
  stopped: { text: "stopped", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
};

const AIRBORNE: readonly Phase[] = ["lift", "guided", "land", "hold", "contact", "limited"];

/** Whether a vehicle whose rotors stop would fall. */
export function isAirborne(phase: Phase): boolean {
  return AIRBORNE.includes(phase);
}

/** A phase in words, and the colour of its stretch of time. */
export function phaseLook(phase: Phase): { text: string; tint: string } {
  return LOOKS[phase];
}

/** What the badge says: a fault before all else. */
export function badgeOf({ phase, alarm }: StatusMessage): { text: string; kind: string } {
  const { text, kind } = LOOKS[phase];
  if (alarm.startsWith(text)) return { text: alarm, kind: "fault" };
  return alarm ? { text: `${text} \u00b7 fault: ${alarm}`, kind: "fault" } : { text, kind };
}
