// The help that opens over the page.

import { byId, el } from "./dom.ts";

const LIVE: [string, string][] = [
  ["Drag the beam", "pull it with mouse or finger"],
  ["Wheel, or a second finger, while dragging", "push away or pull near; with a level plane, up or down"],
  ["Drag elsewhere \u00b7 wheel \u00b7 right button", "turn the view \u00b7 zoom \u00b7 shift"],
  ["Arrows or W A S D", "push level; the force is set under Settings \u2192 hand"],
  ["E, Q or Page Up, Page Down", "push up, down"],
  ["Gamepad", "left stick: level; right stick: up and down"],
  ["L \u00b7 K \u00b7 P", "lift \u00b7 land \u00b7 pause"],
  ["1 2 3 \u00b7 F", "view from behind, the side, above \u00b7 follow the vehicle"],
];
const REPLAY: [string, string][] = [
  ["P", "play or pause"],
  ["Left, Right", "one second back, on"],
  ["Drag \u00b7 wheel \u00b7 right button", "turn the view \u00b7 zoom \u00b7 shift"],
  ["1 2 3 \u00b7 F", "view from behind, the side, above \u00b7 follow the vehicle"],
];
const LEGEND: [string, string, string][] = [
  ["push", "red arrow", "true push on the beam"],
  ["hand", "violet box and spring", "the hand; inside the box a pull is below the threshold and moves nothing"],
  ["thrust", "green to red arrows", "thrust of each rotor; red is near its maximum"],
  ["path", "blue shape and line", "the reference, where the vehicle is off it; the path flown"],
  ["wind", "light blue arrow", "the wind"],
];

export function helpDialog(replay: boolean): HTMLDialogElement {
  const dialog = byId("help") as HTMLDialogElement;
  const keys = (replay ? REPLAY : LIVE).flatMap(([key, text]) => [el("dt", {}, key), el("dd", {}, text)]);
  const legend = LEGEND.flatMap(([kind, what, text]) => [
    el("dt", {}, el("i", { class: `dot ${kind}` }), what),
    el("dd", {}, text),
  ]);
  const close = el("button", { type: "button", class: "go" }, "Close");
  close.addEventListener("click", () => {
    dialog.close();
  });
  const hold = "One page holds the beam at a time. It lets go when it loses the focus or the connection.";
  const notes = replay ? [] : [el("p", {}, hold)];
  const parts = [el("h2", {}, replay ? "A saved flight" : "Push the beam yourself"), el("dl", {}, ...keys)];
  dialog.replaceChildren(...parts, el("h3", {}, "What is shown"), el("dl", {}, ...legend), ...notes, close);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}
