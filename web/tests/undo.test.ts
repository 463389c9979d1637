import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./dom.ts";
import { Undo } from "../src/ui/undo.ts";
import type { PageMessage, SceneParameter } from "../src/wire/messages.generated.ts";

const parameters = (mass: number, damping: number): SceneParameter[] =>
  Object.entries({ mass, damping }).map(([key, value]) => ({ key, value, label: key, group: "" }));

/** A flight that does what it is told, and says so. */
function flying(): {
  undo: Undo;
  values: Record<string, unknown>;
  set: (key: string, value: number, now: number) => void;
  link: { up: boolean };
} {
  const link = { up: true };
  const values: Record<string, unknown> = { mass: 1, damping: 2 };
  const undo: Undo = new Undo((message: PageMessage) => {
    if (message.type !== "set" || !link.up) return null;
    values[message.key] = message.value;
    undo.changed(message.key, message.value, 1e6);
    return 1;
  });
  undo.scene(parameters(1, 2));
  const set = (key: string, value: number, now: number): void => {
    values[key] = value;
    undo.changed(key, value, now);
  };
  return { undo, values, set, link };
}

test("settings come back in the other order, and can be made again", () => {
  const { undo, values, set } = flying();
  set("mass", 3, 0);
  set("damping", 5, 1000);
  undo.undo();
  assert.deepEqual(values, { mass: 3, damping: 2 });
  undo.undo();
  undo.undo();
  assert.deepEqual(values, { mass: 1, damping: 2 });
  undo.redo();
  undo.redo();
  undo.redo();
  assert.deepEqual(values, { mass: 3, damping: 5 });
});

test("what was changed at once comes back at once, and a new change ends what could be made again", () => {
  const { undo, values, set } = flying();
  set("mass", 3, 0);
  set("damping", 5, 1);
  undo.undo();
  assert.deepEqual(values, { mass: 1, damping: 2 });
  set("mass", 7, 9000);
  undo.redo();
  assert.deepEqual(values, { mass: 7, damping: 2 });
  undo.undo();
  assert.deepEqual(values, { mass: 1, damping: 2 });
});

test("a flight with other values has nothing to take back; one that begins again with the same has", () => {
  const { undo, values, set } = flying();
  set("mass", 3, 0);
  undo.scene(parameters(3, 2));
  undo.undo();
  assert.equal(values["mass"], 1);
  undo.redo();
  undo.scene(parameters(1, 2));
  undo.undo();
  assert.equal(values["mass"], 3);
});

const press = (key: string, code: string, shiftKey = false): KeyboardEvent =>
  ({ ctrlKey: true, metaKey: false, shiftKey, key, code, target: null }) as unknown as KeyboardEvent;

test("the letters Z and Y are meant, wherever they stand on the keyboard", () => {
  const { undo, values, set } = flying();
  set("mass", 3, 0);
  assert.ok(undo.key(press("z", "KeyY"))); // of a German keyboard
  assert.equal(values["mass"], 1);
  assert.ok(undo.key(press("y", "KeyZ")));
  assert.equal(values["mass"], 3);
  undo.undo();
  assert.ok(undo.key(press("Z", "KeyY", true)));
  assert.equal(values["mass"], 3);
});

test("a key in an open dialog takes nothing back behind it", () => {
  const { undo, values, set } = flying();
  set("mass", 3, 0);
  page.getElementById("question").showModal();
  assert.ok(!undo.key(press("z", "KeyZ")));
  page.getElementById("question").open = false;
  assert.equal(values["mass"], 3);
  assert.ok(undo.key(press("z", "KeyZ")));
  assert.equal(values["mass"], 1);
});

test("what cannot be sent can be taken back, and made again, once it can", () => {
  const { undo, values, set, link } = flying();
  set("mass", 3, 0);
  link.up = false;
  undo.undo();
  link.up = true;
  undo.redo();
  assert.equal(values["mass"], 3);
  undo.undo();
  assert.equal(values["mass"], 1);
  link.up = false;
  undo.redo();
  link.up = true;
  undo.redo();
  assert.equal(values["mass"], 3);
});
