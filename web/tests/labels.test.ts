import assert from "node:assert/strict";
import { test } from "node:test";

import { PerspectiveCamera, Vector3 } from "three";

import { labelsIn } from "../src/view/labels.ts";

const [WIDTH, HEIGHT] = [60, 18]; // pixels, of each label
const layer: { element: { style: { transform: string } }[] } & Record<string, unknown> = {
  element: [],
  clientWidth: 400,
  clientHeight: 300,
  append: (one: { style: { transform: string } }) => layer.element.push(one),
};
const size = { offsetLeft: 8, offsetTop: 6, offsetWidth: WIDTH, offsetHeight: HEIGHT };
Object.assign(globalThis, {
  document: { createElement: () => ({ ...size, hidden: false, style: { transform: "" } }) },
  ResizeObserver: class {
    constructor(readonly seen: () => void) {}
    observe(): void {
      this.seen();
    }
  },
});

test("a label moves below those that it would cover, and back once they are gone", () => {
  const camera = new PerspectiveCamera();
  const { push, moment, wind } = labelsIn(layer as unknown as HTMLElement);
  const middle = new Vector3(0, 0, -5);
  const drop = (): number[] => layer.element.map(({ style }) => Number(/, (.*)px/.exec(style.transform)?.[1]) - 150);
  push.show("0.88 N", middle, camera);
  moment.show("0.1 N m", middle, camera);
  wind.show("wind 2.0 m/s", middle, camera);
  assert.deepEqual(drop().slice(0, 3), [0, HEIGHT, 2 * HEIGHT]);
  push.hide();
  moment.show("0.1 N m", middle, camera);
  wind.show("wind 2.0 m/s", new Vector3(3, 0, -5), camera);
  assert.deepEqual(drop().slice(1, 3), [0, 0]);
});
