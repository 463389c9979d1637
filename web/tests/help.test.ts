import assert from "node:assert/strict";
import { test } from "node:test";

import { helpLines } from "../src/ui/help.ts";

test("gestures come before keys, and those of fingers name no mouse", () => {
  for (const replay of [false, true]) {
    for (const touch of [false, true]) {
      const names = helpLines(replay, touch).map(([name]) => name);
      const gestures = names.filter((name) => /drag|finger|wheel/i.test(name));
      assert.deepEqual(names.slice(0, gestures.length), gestures);
      assert.equal(gestures.some((name) => name.includes("finger")), touch);
      assert.equal(gestures.some((name) => /wheel|button/i.test(name)), !touch);
    }
  }
});

test("of fingers no key and no gamepad is named", () => {
  for (const replay of [false, true]) {
    const words = helpLines(replay, true).flat().join(" ");
    assert.doesNotMatch(words, /gamepad|arrow|W A S D|Ctrl|\b[A-Z] \u00b7|\bkey/i);
  }
});
