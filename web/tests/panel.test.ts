import assert from "node:assert/strict";
import { test } from "node:test";

import { fake, type FakeElement } from "./dom.ts";
import { Panel, type PanelPage } from "../src/ui/panel.ts";
import type { FlightScene } from "../src/wire/messages.generated.ts";

const nothing = (): void => undefined;

/** A flight with one setting, up to a most. */
function flight(value: number, max = 9): FlightScene {
  const vehicle = { quadrotors: [], payload: { length: 1, width: 0.1, position: [0, 0, 0] } };
  const parameters = [{ key: "mass", label: "mass", group: "body", value, initial: 1, min: 0, max }];
  return { mission: "hover", vehicle, parameters, spring: { max_force: 20 } } as unknown as FlightScene;
}

test("a flight that begins again leaves what is half written, and other flights have what was chosen", () => {
  const place = document.createElement("aside");
  const hand = { at: "point", plane: "facing", kind: "push", frequency: 4, force: 3, directions: "view" } as const;
  const choices = { theme: "dark", graphicsChoice: "full", setGraphics: nothing, setTheme: nothing } as const;
  const page: PanelPage = { hand, extra: [], send: () => 1, ...choices };
  const panel = new Panel(place, page, document.createElement("div"));
  const inputs = (): FakeElement[] => fake(place).querySelectorAll("input");
  const written = (): FakeElement => inputs().find((one) => one.attributes.get("aria-label") === "mass")!;
  panel.scene(flight(1));
  const entry = written();
  entry.value = "2.";
  panel.scene(flight(1));
  assert.equal(written(), entry);
  assert.equal(entry.value, "2.");
  panel.scene(flight(4));
  assert.equal(entry.value, "4");
  panel.scene(flight(4, 50));
  assert.notEqual(written(), entry);
  const chosen = fake(place).querySelectorAll("button").filter((one) => one.attributes.get("aria-pressed") === "true");
  assert.deepEqual(chosen.map((one) => one.textContent).slice(-2), ["full", "dark"]);
});

test("what is no finite number is named at its parameter, sent nowhere, and gives way to the value there was", () => {
  const place = document.createElement("aside");
  const sent: unknown[] = [];
  const hand = { at: "point", plane: "facing", kind: "push", frequency: 4, force: 3, directions: "view" } as const;
  const choices = { theme: "dark", graphicsChoice: "full", setGraphics: nothing, setTheme: nothing } as const;
  const send = (message: unknown): number => sent.push(message);
  const panel = new Panel(place, { hand, extra: [], send, ...choices }, document.createElement("div"));
  panel.scene(flight(4));
  const entry = fake(place).querySelectorAll("input").find((one) => one.attributes.get("aria-label") === "mass")!;
  const reason = (): string => fake(place).querySelectorAll("p").map((one) => one.textContent).join("");
  for (const [typed, named] of [["", "what was entered"], ["NaN", "NaN"], ["1e999", "1e999"], ["two", "two"]]) {
    entry.value = typed;
    entry.event("change");
    assert.match(reason(), new RegExp(`mass: ${named} is no finite number`));
    assert.equal(entry.value, "4");
  }
  assert.deepEqual(sent, []);
  entry.value = "5";
  entry.event("change");
  assert.deepEqual(sent, [{ type: "set", key: "mass", value: 5 }]);
});
