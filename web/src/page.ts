// The live page: a flight to look at, and a beam to pull.

import "./page.css";

import { App } from "./app.ts";
import { Connection, socketAddress } from "./wire/connection.ts";
import { embedded } from "./wire/recorded.ts";

const flight = embedded();
const app = new App(flight ?? new Connection(socketAddress(window.location)), flight);
app.start();
