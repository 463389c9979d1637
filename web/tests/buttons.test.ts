// What the buttons of a flight do where the flight answers late or not at all.

import assert from "node:assert/strict";
import { test } from "node:test";

import { fake, page } from "./dom.ts";
import { Dock } from "../src/ui/dock.ts";
import { Question } from "../src/ui/question.ts";
import { RotorMap } from "../src/ui/rotor_map.ts";
import { SaveDialog } from "../src/ui/save_dialog.ts";
import type { FlightScene, PageMessage } from "../src/wire/messages.generated.ts";

test("a flight that is not open is not saved, and the dialog says so", () => {
  new SaveDialog(() => null).open("mine");
  const [form] = page.getElementById("saving").children;
  form.event("submit");
  assert.match(form.querySelector("p")!.textContent, /No flight is open/);
  const [, submit] = form.querySelector("div")!.children;
  assert.deepEqual([submit["disabled"], submit.textContent], [false, "Save"]);
});

test("two presses of P before the flight answers pause it and let it go on", () => {
  const sent: PageMessage[] = [];
  const nothing = (): void => undefined;
  const place = document.createElement("div");
  const actions = { height: () => null, open: nothing, save: nothing, film: nothing };
  const dock = new Dock(place, (message) => sent.push(message), new Question(), actions);
  for (const name of ["Continue", "Pause"]) {
    dock.togglePause();
    const [button] = fake(place).children[3].children;
    assert.equal(button.querySelector("span")!.textContent, name);
  }
  assert.deepEqual(sent, [{ type: "pause", on: true }, { type: "pause", on: false }]);
});

test("Space stops a rotor as Enter does, and a stopped one says so", () => {
  const sent: PageMessage[] = [];
  const rotors = [{ position: [0.2, 0.2, 0], radius: 0.1, max_thrust: 5, disc: { color: "red" } }];
  const payload = { length: 1, width: 0.1, position: [0, 0, 0] };
  const vehicle = { quadrotors: [{ position: [0, 0, 0], guard: 0.3, rotors }], payload };
  const map = new RotorMap({ vehicle } as unknown as FlightScene, (message) => sent.push(message));
  const [picture, note] = fake(map.element).children;
  const spot = picture.children.at(-1)!;
  const look = (): unknown[] => ["aria-label", "aria-disabled"].map((name) => spot.attributes.get(name));
  assert.deepEqual([...look(), note.attributes.get("role")], ["Stop rotor 1", "false", "status"]);
  for (const key of [" ", "Tab", "Enter"]) spot.event("keydown", { key });
  assert.deepEqual(sent, [{ type: "kill", rotor: 0 }]);
  map.markFailed([0]);
  assert.deepEqual(look(), ["Rotor 1, stopped", "true"]);
});
