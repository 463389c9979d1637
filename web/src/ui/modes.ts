// The pilot's phases in words for a person, with a colour each.

import type { Status } from "../wire/protocol.ts";

interface Mode {
  text: string;
  kind: "calm" | "active" | "moving" | "fault" | "off";
  tint: string;
}

const MODES: Partial<Record<string, Mode>> = {
  preparing: { text: "being prepared", kind: "off", tint: "rgba(0, 0, 0, 0)" },
  idle: { text: "on the ground", kind: "off", tint: "rgba(93, 104, 117, 0.10)" },
  lift: { text: "lifting", kind: "moving", tint: "rgba(240, 180, 41, 0.16)" },
  guided: { text: "guided", kind: "active", tint: "rgba(31, 157, 118, 0.13)" },
  land: { text: "landing", kind: "moving", tint: "rgba(240, 180, 41, 0.16)" },
  hold: { text: "holding", kind: "calm", tint: "rgba(47, 111, 176, 0.12)" },
  lost: { text: "out of control", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
  over: { text: "over: reset it", kind: "off", tint: "rgba(93, 104, 117, 0.10)" },
  failed: { text: "failed: reset it", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
  stopped: { text: "stopped", kind: "fault", tint: "rgba(213, 40, 27, 0.12)" },
};

export function phaseTint(phase: string): string {
  return MODES[phase]?.tint ?? "rgba(0, 0, 0, 0)";
}

/** What the badge says: a fault before all else. */
export function modeOf({ phase, alarm }: Status): { text: string; kind: string } {
  const mode = MODES[phase] ?? { text: phase || "flying", kind: "calm" };
  if (alarm) return { text: `${mode.text} \u00b7 fault: ${alarm}`, kind: "fault" };
  return { text: mode.text, kind: mode.kind };
}
