// What the browser keeps of what a person chose; nothing where it refuses, as on pages without an origin.

function storage(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}

export function kept(name: string): string | null {
  return storage()?.getItem(name) ?? null;
}

/** Keeps a text, if there is room for it. */
export function keep(name: string, text: string): void {
  try {
    storage()?.setItem(name, text);
  } catch {
    // full: the page goes on without
  }
}

/** What is kept as JSON; null if there is none, or it is damaged. */
export function keptData(name: string): unknown {
  try {
    return JSON.parse(kept(name) ?? "null");
  } catch {
    return null;
  }
}
