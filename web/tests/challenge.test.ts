import assert from "node:assert/strict";
import { test } from "node:test";

import { fake, stored } from "./dom.ts";
import { Challenge } from "../src/ui/challenge.ts";
import type { Frame } from "../src/wire/frames.ts";
import type { FlightScene, StatusMessage } from "../src/wire/messages.generated.ts";

const nothing = (): void => undefined;
const RATE = 60; // pictures/s
const PUSH = 1; // s, of the first push

const SCENE = { mission: "zigzag", parameters: [], corridor: {} } as unknown as FlightScene;

/** A frame at a time [s], at which the vehicle is as many metres along x. */
function frame(time: number): Frame {
  const vector = (name: string): number[] => [name === "push" ? Number(time >= PUSH) : time, 0, 0];
  return { scalar: () => time, vector, attitude: [1, 0, 0, 0] } as unknown as Frame;
}

function status(time: number): StatusMessage {
  const score = { start: PUSH, finished: time >= 8, refused: "", time: time - PUSH, touches: 0, effort: 0, jerk: 0 };
  return { score: { ...score, score: time - PUSH } } as unknown as StatusMessage;
}

function fly(challenge: Challenge, from: number, to: number): void {
  for (let i = from * RATE; i <= to * RATE; i++) {
    challenge.frame(frame(i / RATE));
    if (i % 6 === 0 && i > (PUSH + 0.1) * RATE) challenge.status(status(i / RATE));
  }
}

test("the best run is where it was at each time, also after a rewind within it and one before it", () => {
  for (const stops of [[], [[5, 3]], [[5, 3], [6, 2]], [[5, 0]]] as const) {
    stored.clear();
    const challenge = new Challenge(nothing, nothing, nothing);
    challenge.begin(SCENE);
    challenge.button.click();
    let from = 0;
    for (const [to, back] of stops) {
      fly(challenge, from, to);
      from = back;
    }
    fly(challenge, from, 8);
    const { poses } = JSON.parse(stored.get("tandemlift.best.zigzag")!) as { poses: number[] };
    const x = poses.filter((_, i) => i % 7 === 0);
    assert.ok(x.length >= 70);
    x.forEach((value, i) => assert.ok(Math.abs(value - (PUSH + i / 10)) < 0.04, `${value} m after ${i / 10} s`));
  }
});

/** The clock, the note, and the buttons that are offered. */
function shown(challenge: Challenge): [string, string, string[]] {
  challenge.tick();
  const strip = fake(challenge.element).children[0];
  const [time] = strip.querySelectorAll("dd");
  const [actions] = strip.children.slice(-1);
  const offered = actions.hidden ? [] : actions.children.filter((one) => !one.hidden).map((one) => one.querySelector("span")!.textContent);
  return [time.textContent, strip.querySelector("p")!.textContent, offered];
}

test("it begins when it is asked for: a flight that was pushed before does not count, and a new run is offered", () => {
  stored.clear();
  stored.set("tandemlift.challenge", "on"); // as an earlier version kept it
  let again = 0;
  const challenge = new Challenge(nothing, () => (again += 1), nothing);
  challenge.begin(SCENE);
  assert.equal(challenge.element.hidden, true);
  fly(challenge, 0, 3);
  challenge.button.click();
  assert.equal(challenge.element.hidden, false);
  const [clock, note, offered] = shown(challenge);
  assert.deepEqual([clock, offered], ["\u2013", ["New run"]]);
  assert.match(note, /was pushed before/);
  fly(challenge, 3, 8);
  assert.deepEqual(shown(challenge)[2], ["New run"]); // nothing to hand in
  assert.equal(stored.get("tandemlift.best.zigzag"), undefined);
  challenge.begin(SCENE); // a new run
  fly(challenge, 0, 3);
  assert.deepEqual([shown(challenge)[0], shown(challenge)[2]], ["2.0 s", []]);
  fly(challenge, 3, 8);
  assert.deepEqual(shown(challenge)[2], ["Save to hand in", "New run"]);
  assert.ok(stored.get("tandemlift.best.zigzag"));
});

test("asked for before the first push it counts from that push", () => {
  stored.clear();
  const challenge = new Challenge(nothing, nothing, nothing);
  challenge.begin(SCENE);
  fly(challenge, 0, PUSH - 0.5);
  challenge.button.click();
  fly(challenge, PUSH - 0.5, 3);
  assert.deepEqual([shown(challenge)[0], shown(challenge)[2]], ["2.0 s", []]);
});
