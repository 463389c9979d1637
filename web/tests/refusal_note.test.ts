import assert from "node:assert/strict";
import { test } from "node:test";

import { greyFor } from "../src/ui/refusal_note.ts";

test("a reason that both buttons have is told once, others one after the other", () => {
  const [over, landed] = ["Lift is refused: the flight is over.", "Landing is refused: the vehicle stands on the ground."];
  assert.equal(greyFor(over, "Landing is refused: the flight is over."), over);
  assert.equal(greyFor("", landed), landed);
  assert.equal(greyFor(over, landed), `${over} ${landed}`);
  assert.equal(greyFor("", ""), "");
});
