import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./dom.ts";
import { SensesOfFlight } from "../src/ui/senses.ts";

test("a hidden page is silent, and sounds again once it is seen", () => {
  const told: string[] = [];
  const AudioContext = class {
    suspend = (): number => told.push("suspend");
    resume = (): number => told.push("resume");
  };
  Object.assign(globalThis, { AudioContext });
  const senses = new SensesOfFlight({ rotors: true, touches: false, vibration: false });
  page.event("visibilitychange"); // before there is a sound
  assert.ok(senses["audio"]);
  for (const hidden of [true, false]) {
    page.hidden = hidden;
    page.event("visibilitychange");
  }
  assert.deepEqual(told, ["suspend", "resume"]);
});
