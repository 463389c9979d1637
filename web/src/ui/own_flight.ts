// The controls of a page that flies without a server: the link, and what only a server has.

import type { OwnFlight } from "../flight/client.ts";
import { el } from "./dom.ts";

const SAID_FOR = 2000; // ms

/** The panel's group: a link to this mission with its settings, and what only a server has. */
export function ownFlightGroup(flight: OwnFlight, address: () => string): HTMLElement {
  const link = el("input", { type: "text", readonly: true, id: "link", "aria-label": "Link to this flight" });
  const copy = el("button", { type: "button", id: "copy-link" }, "Copy link");
  copy.addEventListener("click", () => {
    link.value = address();
    link.select();
    void copied(link).then((done) => {
      copy.textContent = done ? "Copied" : "Selected";
      window.setTimeout(() => (copy.textContent = "Copy link"), SAID_FOR);
    });
  });
  const row = el("div", { class: "link" }, link, copy);
  const list = el("ul", {}, ...flight.onlyServer.map((one) => el("li", {}, one)));
  const note = el("p", { class: "note" }, "This page flies by itself. With tandemlift installed, ");
  note.append(el("code", {}, "tandemlift live"), " also has:");
  const summary = el("summary", {}, "this page");
  return el("details", { "data-name": "this page", class: "own-flight" }, summary, row, note, list);
}

async function copied(link: HTMLInputElement): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(link.value);
    return true;
  } catch {
    return false; // on a page without encryption there is no clipboard; the text is selected
  }
}
