// The live page: shows a flight, and lets a person pull the beam.

import "./style/base.css";
import "./style/buttons.css";
import "./style/bar.css";
import "./style/picture.css";
import "./style/plots.css";
import "./style/panel.css";
import "./style/dialogs.css";
import "./style/small_windows.css";

import { App } from "./app.ts";
import { Connection, socketAddress } from "./wire/connection.ts";
import { embeddedReplay } from "./wire/replay.ts";

const replay = embeddedReplay();
const app = new App(replay ?? new Connection(socketAddress(window.location)), replay);
app.start();
