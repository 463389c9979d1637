// What the page carries: the index of its flights, and what it shows where they cannot be flown.

import { type FlightIndex, FORMAT } from "./manifest.ts";

/** The index of the page's own flights; null in a page that a server sent. */
export function embeddedIndex(): FlightIndex | null {
  const text = document.getElementById("flights")?.textContent;
  return text ? (JSON.parse(text) as FlightIndex) : null;
}

/** Why this browser cannot fly the page's flights; empty if it can. */
export function obstacle(index: FlightIndex): string {
  if (index.format !== FORMAT) return index.other_version;
  return "WebAssembly" in globalThis && "DecompressionStream" in globalThis ? "" : index.no_module;
}
