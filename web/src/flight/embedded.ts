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

/** A worker that flies: its code is in a page that is one file, and beside any other. */
export function newWorker(): Worker {
  const code = document.getElementById("worker")?.textContent;
  if (!code) return new Worker("worker.js");
  const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  return worker;
}
