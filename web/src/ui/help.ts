// The help that opens over the page.

import { byId, el } from "./dom.ts";

type Line = [string, string];

const MOUSE: Line[] = [
  ["Drag the beam", "pull it"],
  ["Wheel, while dragging", "push away or pull near; with a level plane, up or down"],
];
const FINGERS: Line[] = [
  ["Drag the beam with a finger", "pull it"],
  ["Second finger up or down, meanwhile", "push away or pull near; with a level plane, up or down"],
];
const KINDS: Line = ["Push, Shake, Tap", "pull; shake with the force of the drag as its peak; a push of 50 ms away from you"];
const MOUSE_VIEW: Line = ["Drag elsewhere \u00b7 wheel \u00b7 right button", "turn the view \u00b7 zoom \u00b7 shift"];
const FINGERS_VIEW: Line = ["Drag elsewhere \u00b7 two fingers", "turn the view \u00b7 zoom and shift"];
const MOUSE_PLOTS: Line = [
  "Plots: point \u00b7 drag or wheel \u00b7 double click",
  "values there \u00b7 zoom in time \u00b7 the last 20 s again",
];
const FINGERS_PLOTS: Line = [
  "Plots: tap \u00b7 two fingers \u00b7 double tap",
  "values there \u00b7 zoom in time \u00b7 the last 20 s again",
];
const FINGERS_REWIND: Line = ["Rewind, below the picture", "fly again to the chosen moment, and try again from there"];
const KEYS: Line[] = [
  ["Arrows or W A S D", "push level; the force is set under Settings \u2192 Hand"],
  ["E, Q or Page Up, Page Down", "push up, down"],
  ["Gamepad", "left stick: level; right stick: up and down"],
  ["R \u00b7 Ctrl+Z", "fly again to the chosen moment, and try again from there \u00b7 undo a setting"],
  ["5 6 7 \u00b7 L \u00b7 K \u00b7 P", "push, shake, tap \u00b7 lift \u00b7 land \u00b7 pause"],
];
const LECTURE_KEY: Line = ["T", "lecture: full screen, large type, one quantity, the steps of a script"];
const REPLAY_KEYS: Line[] = [
  ["P", "play or pause"],
  ["Left, Right", "one second back, on"],
];
const VIEW_KEYS: Line = ["1 2 3 4 \u00b7 F", "view from behind, the side, above, on board \u00b7 follow the vehicle"];
const LEGEND: [string, string, string][] = [
  ["best", "amber shape", "the ghost of a comparison, or your best run in a challenge"],
  ["push", "red arrow", "true push on the beam; the curved one is its moment about the centre of mass"],
  ["hand", "violet hoop", "the admittance's threshold: a push whose arrow does not pass it moves nothing"],
  ["hand", "violet box and spring", "the hand; inside the box a pull is below the threshold and moves nothing"],
  ["thrust", "green to red arrows", "thrust of each rotor; red is near its maximum"],
  ["front", "thrusts: front", "rotors ahead of the middle of their quadrotor, left or right: towards +x, a shade for each"],
  ["rear", "thrusts: rear", "rotors behind the middle of their quadrotor"],
  ["path", "blue shape and line", "the reference, where the vehicle is off it; the path flown"],
  ["wind", "light blue arrow", "the wind"],
];

/** What a person can do, gestures first: of fingers where they are what the page is used with, else of a mouse; keys. */
export function helpLines(replay: boolean, touch: boolean): Line[] {
  const pull = touch ? FINGERS : MOUSE;
  const look = touch ? [FINGERS_VIEW, FINGERS_PLOTS] : [MOUSE_VIEW, MOUSE_PLOTS];
  const own = replay ? look : [...pull, ...look, KINDS];
  if (touch) return replay ? own : [...own, FINGERS_REWIND];
  return [...own, ...(replay ? REPLAY_KEYS : KEYS), VIEW_KEYS, LECTURE_KEY];
}

export function helpDialog(replay: boolean): HTMLDialogElement {
  const dialog = byId("help") as HTMLDialogElement;
  const touch = window.matchMedia("(pointer: coarse)").matches;
  const keys = helpLines(replay, touch).flatMap(([key, text]) => [el("dt", {}, key), el("dd", {}, text)]);
  const legend = LEGEND.flatMap(([kind, what, text]) => [
    el("dt", {}, el("i", { class: `dot ${kind}` }), what),
    el("dd", {}, text),
  ]);
  const close = el("button", { type: "button", class: "go" }, "Close");
  close.addEventListener("click", () => dialog.close());
  const hold = "One page holds the beam at a time. It lets go when it loses the focus or the connection.";
  const notes = replay ? [] : [el("p", {}, hold)];
  const parts = [el("h2", { id: "help-title" }, replay ? "A saved flight" : "Push the beam yourself"), el("dl", {}, ...keys)];
  dialog.replaceChildren(...parts, el("h3", {}, "What is shown"), el("dl", {}, ...legend), ...notes, close);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}
