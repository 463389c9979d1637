// Names of files that the page makes.

/** A name with date and time, such as zigzag-2026-11-22-091500; 64 characters at most. */
export function timedName(mission: string): string {
  const stamp = new Date().toISOString().slice(0, 19).replace("T", "-").replaceAll(":", "");
  return `${mission.slice(0, 64 - stamp.length - 1)}-${stamp}`;
}
