// Which theme a choice means, and what a stored choice that nobody made means.

import assert from "node:assert/strict";
import { test } from "node:test";

import { readChoice, themeOf } from "../src/ui/theme.ts";
import { palette, setPalette } from "../src/view/palette.ts";

test("a choice of light or dark holds whatever the system prefers, automatic follows it", () => {
  for (const dark of [true, false]) {
    assert.equal(themeOf("light", dark), "light");
    assert.equal(themeOf("dark", dark), "dark");
    assert.equal(themeOf("auto", dark), dark ? "dark" : "light");
  }
});

test("what is stored and is no theme means automatic", () => {
  assert.equal(readChoice("dark"), "dark");
  for (const text of [null, "", "auto", "Dark", "toString"]) assert.equal(readChoice(text), "auto");
});

function luminance(color: string): number {
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16) / 255);
  const linear = (v: number): number => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
}

test("push, hand and path stand out from floor and sky of both themes", () => {
  for (const theme of ["light", "dark"] as const) {
    setPalette(theme);
    for (const ground of [palette.pale, palette.haze]) {
      for (const drawn of [palette.push, palette.hand, palette.path]) {
        const [low, high] = [luminance(ground), luminance(drawn)].sort((a, b) => a - b);
        assert.ok((high + 0.05) / (low + 0.05) >= 3, `${drawn} on ${ground}`);
      }
    }
  }
});
