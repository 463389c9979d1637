import assert from "node:assert/strict";
import { test } from "node:test";

import { fake, type FakeElement } from "./dom.ts";
import { menu } from "../src/ui/dom.ts";

/** A menu, what it did, and what a person does: a key on it, and a choice after it. */
function using(late: boolean): { list: FakeElement; done: string[]; key: (key: string, then?: string) => void } {
  const done: string[] = [];
  const list = fake(menu({}, (value) => done.push(value), late));
  list.focus();
  const key = (name: string, then?: string): void => {
    list.event("keydown", { key: name, altKey: false });
    if (then !== undefined) choose(list, then);
  };
  return { list, done, key };
}

function choose(list: FakeElement, value: string): void {
  list.value = value;
  list.event("change");
}

test("arrow keys go through the closed list; what they reach acts late where it should", () => {
  const speeds = using(false);
  speeds.key("ArrowDown", "0.5");
  speeds.key("ArrowDown", "0.25");
  assert.deepEqual([speeds.done, speeds.list.focused], [["0.5", "0.25"], true]);
  const missions = using(true);
  missions.key("ArrowDown", "iris");
  missions.key("ArrowDown", "doorway");
  assert.deepEqual([missions.done, missions.list.focused], [[], true]);
  missions.key("Enter");
  assert.deepEqual(missions.done, ["doorway"]);
  missions.key("ArrowUp", "iris");
  missions.list.blur();
  assert.deepEqual(missions.done, ["doorway", "iris"]);
});

test("what is chosen in the open list acts at once, and the focus goes back to the page", () => {
  for (const open of ["pointer", " ", "Enter"]) {
    const { list, done, key } = using(true);
    key("ArrowDown");
    if (open === "pointer") list.event("pointerdown");
    else key(open);
    choose(list, "iris");
    assert.deepEqual([done, list.focused], [["iris"], false]);
  }
});

test("what was reached by keys is forgotten once the menu shows another mission", () => {
  const { list, done, key } = using(true);
  key("ArrowDown", "iris");
  list.value = "hover";
  list.blur();
  assert.deepEqual(done, []);
});
