// The live page: shows a flight, and lets a person pull the beam.

import "./style/base.css";
import "./style/buttons.css";
import "./style/bar.css";
import "./style/picture.css";
import "./style/plots.css";
import "./style/timeline.css";
import "./style/panel.css";
import "./style/dialogs.css";
import "./style/lecture.css";
import "./style/own_flight.css";
import "./style/small_windows.css";

import { App } from "./app.ts";
import { OwnFlight } from "./flight/client.ts";
import { embeddedIndex, newWorker, obstacle } from "./flight/embedded.ts";
import { readLink } from "./flight/link.ts";
import type { FlightIndex } from "./flight/manifest.ts";
import { byId } from "./ui/dom.ts";
import { MissionMenu } from "./ui/mission_menu.ts";
import { ownFlightGroup } from "./ui/own_flight.ts";
import { Connection, socketAddress } from "./wire/connection.ts";
import { embeddedReplay } from "./wire/replay.ts";

/** Flies a flight that the page carries. */
function fly(index: FlightIndex): void {
  const link = () => readLink(window.location.hash);
  const flight = new OwnFlight(index, newWorker, link);
  const address = (): string => window.location.href.replace(/#.*/, "") + flight.link;
  const menu = new MissionMenu(flight.missions, (mission) => {
    window.history.replaceState(null, "", `#mission=${mission}`);
    flight.open(mission, []);
  });
  flight.opened = (mission) => menu.show(mission);
  window.addEventListener("hashchange", () => flight.restart());
  new App(flight, null, [ownFlightGroup(flight, address)]).start();
}

/** Shows a flight that the page carries, or that of the page's server. */
function watch(sentence: string): void {
  const replay = embeddedReplay();
  const app = new App(replay ?? new Connection(socketAddress(window.location)), replay);
  app.start();
  window.addEventListener("message", ({ source, data }: MessageEvent<{ seek?: number }>) => {
    if (source === window.parent && typeof data.seek === "number") replay?.seek(data.seek); // a report's plot was clicked
  });
  if (sentence) app.explain(sentence);
}

/** Says why there is no picture. */
function explainNoPicture(error: unknown): void {
  byId("mode").textContent = "no picture";
  byId("hint").hidden = false;
  byId("hint").textContent = "This browser shows no 3D graphics (WebGL), which the page needs.";
  console.error(error);
}

try {
  const index = embeddedIndex();
  const sentence = index ? obstacle(index) : "";
  if (index && !sentence) fly(index);
  else watch(sentence);
} catch (error) {
  explainNoPicture(error);
}
