import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

import { npyOfDoubles, npyOfIntegers, npyOfText, zip } from "../src/flight/archive.ts";
import { sha256 } from "../src/flight/sha256.ts";
import { toml } from "../src/flight/toml.ts";

test("hashes are those of Node.js, at every length around a block", () => {
  for (const length of [0, 1, 3, 55, 56, 57, 63, 64, 65, 119, 120, 1000, 70_000]) {
    const bytes = Uint8Array.from({ length }, (_, i) => (i * 131 + length) % 256);
    assert.equal(sha256(bytes), createHash("sha256").update(bytes).digest("hex"), `${length} bytes`);
  }
});

/** What Python prints for a program, with a file as its argument. */
function python(program: string, bytes: Uint8Array | string): string {
  const file = join(mkdtempSync(join(tmpdir(), "page-")), "file");
  writeFileSync(file, bytes);
  return execFileSync("python3", ["-c", program, file], { encoding: "utf8" }).trim();
}

test("Python unpacks an archive, and finds every checksum right", () => {
  const files = { "a.txt": new TextEncoder().encode("first"), "empty": new Uint8Array(), "b.bin": Uint8Array.of(0, 255, 10) };
  const program = "import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); print(z.testzip(), {n: z.read(n) for n in z.namelist()})";
  assert.equal(python(program, zip(files)), "None {'a.txt': b'first', 'empty': b'', 'b.bin': b'\\x00\\xff\\n'}");
});

test("an array begins with NumPy's header, at a multiple of 64 bytes", () => {
  const text = (bytes: Uint8Array): string => Buffer.from(bytes).toString("latin1");
  const doubles = npyOfDoubles([1.5, -0], [2, 1]);
  assert.ok(text(doubles).startsWith("\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1), } "));
  assert.deepEqual([...new Float64Array(doubles.slice(128).buffer)], [1.5, -0]);
  assert.match(text(npyOfIntegers([7])), /'<i8', 'fortran_order': False, 'shape': \(1,\)/);
  assert.match(text(npyOfText("compiled")), /'<U8', 'fortran_order': False, 'shape': \(\)/);
});

test("Python reads tables that were written as TOML", () => {
  const tables = {
    one: 1,
    text: 'a "quoted" \\ \n line, \u03be',
    "a key": true,
    list: [0.1, -0, 1e-7, 1e21, Number.POSITIVE_INFINITY],
    none: [],
    inner: { deep: { number: 2.5 }, entries: [{ key: "x", at: [1, 2] }, { key: "y" }] },
    mixed: [[1, 2], [3]],
  };
  const program = "import sys, tomllib; print(tomllib.load(open(sys.argv[1], 'rb')))";
  const read = python(program, toml(tables));
  const expected =
    `{'one': 1, 'text': 'a "quoted" \\\\ \\n line, \u03be', 'a key': True, ` +
    "'list': [0.1, -0.0, 1e-07, 1e+21, inf], 'none': [], 'mixed': [[1, 2], [3]], " +
    "'inner': {'deep': {'number': 2.5}, 'entries': [{'key': 'x', 'at': [1, 2]}, {'key': 'y'}]}}";
  assert.equal(read, expected);
});
