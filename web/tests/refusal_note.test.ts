import assert from "node:assert/strict";
import { test } from "node:test";

import { hintOf } from "../src/ui/hint.ts";
import type { StatusMessage } from "../src/wire/messages.generated.ts";

const hint = (lift: string, land: string): string =>
  hintOf({ phase: "idle", tare_left_s: 0, refusals: { lift, land, push: "" } } as unknown as StatusMessage, false);

test("on the ground the hint says why it may not lift, but nothing where it lifts by itself", () => {
  const landed = "Landing is refused: the vehicle stands on the ground already.";
  assert.equal(hint("", landed), "Press Lift to take off.");
  assert.equal(hint("Lift is refused: a rotor has failed.", landed), "Lift is refused: a rotor has failed.");
  assert.equal(hint("Lift is refused: both are scheduled.", "Landing is refused: both are scheduled."), "");
});
