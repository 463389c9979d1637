// The direction of imports: no circle among files, none among folders, and folders only below their own.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, normalize } from "node:path";
import { test } from "node:test";

type Graph = Map<string, Set<string>>;

const FOLDERS = ["wire", "math", "flight", "view", "hand", "ui", "."]; // from the bottom; `.` is src itself

/** What each file of a folder imports of it, by paths within the folder. */
function graphOf(folder: string): Graph {
  const files = readdirSync(folder, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".ts"));
  return new Map(files.map((file) => [file, new Set(importsOf(file, readFileSync(join(folder, file), "utf8")))]));
}

function importsOf(file: string, text: string): string[] {
  const found = text.matchAll(/(?:from|import)\s*\(?\s*["'](\.[^"']*\.ts)["']/g);
  return [...found].map((match) => normalize(join(dirname(file), match[1])));
}

function folders(files: Graph): Graph {
  const found: Graph = new Map();
  for (const [file, targets] of files) {
    const from = dirname(file);
    const others = [...targets].map((target) => dirname(target)).filter((to) => to !== from);
    found.set(from, new Set([...(found.get(from) ?? []), ...others]));
  }
  return found;
}

/** A circle of a graph, with its beginning again at its end; null if there is none. */
function circleOf(graph: Graph): string[] | null {
  const done = new Set<string>();
  const visit = (node: string, path: string[]): string[] | null => {
    if (path.includes(node)) return [...path.slice(path.indexOf(node)), node];
    if (done.has(node)) return null;
    for (const next of graph.get(node) ?? []) {
      const circle = visit(next, [...path, node]);
      if (circle) return circle;
    }
    done.add(node);
    return null;
  };
  for (const node of graph.keys()) {
    const circle = visit(node, []);
    if (circle) return circle;
  }
  return null;
}

const files = graphOf("src");

test("no files import each other in a circle", () => {
  assert.ok([...files.values()].reduce((sum, targets) => sum + targets.size, 0) > 100, "imports were found");
  assert.equal(circleOf(files), null);
});

test("folders import only from folders below their own", () => {
  for (const [from, targets] of folders(files)) {
    for (const to of targets) assert.ok(FOLDERS.indexOf(to) < FOLDERS.indexOf(from), `${from} imports from ${to}`);
  }
  assert.deepEqual([...folders(files).keys()].sort(), [...FOLDERS].sort());
});

test("a circle among files or folders is found, also one of types alone", () => {
  const planted: Graph = new Map([
    ["a/x.ts", new Set(importsOf("a/x.ts", 'import type { Y } from "../b/y.ts";'))],
    ["b/y.ts", new Set(importsOf("b/y.ts", 'export { z } from "./z.ts";'))],
    ["b/z.ts", new Set(importsOf("b/z.ts", 'const w = await import("../a/w.ts");\nimport "../page.ts";'))],
    ["a/w.ts", new Set<string>()],
  ]);
  assert.deepEqual(planted.get("b/z.ts"), new Set(["a/w.ts", "page.ts"]));
  assert.equal(circleOf(planted), null);
  assert.deepEqual(circleOf(folders(planted)), ["a", "b", "a"]);
  planted.set("a/w.ts", new Set(["a/x.ts"]));
  assert.deepEqual(circleOf(planted), ["a/x.ts", "b/y.ts", "b/z.ts", "a/w.ts", "a/x.ts"]);
});
