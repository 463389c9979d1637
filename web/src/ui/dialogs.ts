// What opens over the page: help, and the name under which a flight is saved.

import { byId, el } from "./dom.ts";

const LIVE: [string, string][] = [
  ["Drag the beam", "pull it, with mouse or finger, in a plane that faces you or is level"],
  ["Wheel, or a second finger, while dragging", "push away or draw near; up or down where the plane is level"],
  ["Drag elsewhere \u00b7 wheel \u00b7 right button", "look around \u00b7 nearer or farther \u00b7 aside"],
  ["Arrows or W A S D", "push level, with the force that Settings \u2192 hand says"],
  ["E, Q or Page Up, Page Down", "push up, down"],
  ["Gamepad", "left stick level, right stick up and down"],
  ["L \u00b7 K \u00b7 P", "lift \u00b7 land \u00b7 pause"],
  ["1 2 3 \u00b7 F", "look from behind, the side, above \u00b7 follow the vehicle"],
];
const REPLAY: [string, string][] = [
  ["P", "play or pause"],
  ["Left, Right", "a second back or on"],
  ["Drag \u00b7 wheel \u00b7 right button", "look around \u00b7 nearer or farther \u00b7 aside"],
  ["1 2 3 \u00b7 F", "look from behind, the side, above \u00b7 follow the vehicle"],
];
const SEEN: [string, string, string][] = [
  ["push", "red arrow", "the push that acts on the beam"],
  [
    "hand",
    "violet box and spring",
    "the hand; a pull that stays inside the box is below the threshold, and moves nothing",
  ],
  ["thrust", "green to red arrows", "thrust of each rotor; red is near the most that it can"],
  ["path", "blue shape", "the reference, where it is off the vehicle; the blue line is the way flown"],
  ["wind", "light blue arrow", "the wind"],
];
const NAME = "[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}";

export function help(replay: boolean): HTMLDialogElement {
  const dialog = byId("help") as HTMLDialogElement;
  const keys = (replay ? REPLAY : LIVE).flatMap(([key, text]) => [el("dt", {}, key), el("dd", {}, text)]);
  const seen = SEEN.flatMap(([kind, what, text]) => [
    el("dt", {}, el("i", { class: `dot ${kind}` }), what),
    el("dd", {}, text),
  ]);
  const close = el("button", { type: "button", class: "go" }, "Close");
  close.addEventListener("click", () => {
    dialog.close();
  });
  const hold = "Only one person holds the beam at a time. Who looks away, or loses the connection, lets go.";
  const notes = replay ? [] : [el("p", {}, hold)];
  const parts = [el("h2", {}, replay ? "A flight, played again" : "Push it yourself"), el("dl", {}, ...keys)];
  dialog.replaceChildren(...parts, el("h3", {}, "What is shown"), el("dl", {}, ...seen), ...notes, close);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}

/** Asks for a name, then saves. */
export function saving(mission: () => string, save: (name: string) => void): () => void {
  const dialog = byId("saving") as HTMLDialogElement;
  const hint = "Letters, digits, '.', '_' or '-', the first a letter or a digit";
  const name = el("input", {
    type: "text",
    required: true,
    pattern: NAME,
    title: hint,
    maxlength: 64,
    id: "save-name",
  });
  const cancel = el("button", { type: "button" }, "Cancel");
  cancel.addEventListener("click", () => {
    dialog.close();
  });
  const actions = el("div", { class: "actions" }, cancel, el("button", { type: "submit", class: "go" }, "Save"));
  const title = el("h2", {}, "Save the flight so far");
  const form = el("form", { method: "dialog" }, title, el("label", { for: "save-name" }, "Name"), name, actions);
  form.addEventListener("submit", () => {
    save(name.value);
  });
  dialog.replaceChildren(form);
  return () => {
    name.value = `${mission()}-${stamp()}`.slice(0, 64);
    dialog.showModal();
    name.select();
  };
}

/** Date and time for a file's name. */
export function stamp(): string {
  return new Date().toISOString().slice(0, 19).replace("T", "-").replaceAll(":", "");
}
