import assert from "node:assert/strict";
import { test } from "node:test";

import { npy, npyOfText, zip } from "../src/flight/archive.ts";

test("an array begins with NumPy's header, at a multiple of 64 bytes", () => {
  const text = (bytes: Uint8Array): string => Buffer.from(bytes).toString("latin1");
  const doubles = npy(Float64Array.of(1.5, -0), "<f8", [2, 1]);
  assert.ok(text(doubles).startsWith("\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1), } "));
  assert.deepEqual([...new Float64Array(doubles.slice(128).buffer)], [1.5, -0]);
  assert.match(text(npy(BigInt64Array.of(7n), "<i8")), /'<i8', 'fortran_order': False, 'shape': \(1,\)/);
  assert.match(text(npyOfText("compiled")), /'<U8', 'fortran_order': False, 'shape': \(\)/);
});

test("the same files give the same archive, whatever the day", (context) => {
  const files = { a: Uint8Array.of(1, 2, 3) };
  const first = zip(files);
  context.mock.timers.enable({ apis: ["Date"], now: 2e12 });
  assert.deepEqual(zip(files), first);
});
