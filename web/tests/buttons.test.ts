// What the buttons of a flight do where the flight answers late or not at all.

import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./dom.ts";
import { SaveDialog } from "../src/ui/save_dialog.ts";

test("a flight that is not open is not saved, and the dialog says so", () => {
  new SaveDialog(() => null).open("mine");
  const [form] = page.getElementById("saving").children;
  form.event("submit");
  assert.match(form.querySelector("p")!.textContent, /No flight is open/);
  const [, submit] = form.querySelector("div")!.children;
  assert.deepEqual([submit["disabled"], submit.textContent], [false, "Save"]);
});
