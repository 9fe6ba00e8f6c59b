// The queries that editors read: what they capture, and that no token of a scene is left out.

import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { scenes } from "../../common/texts.mjs";
import { ask, here, parse } from "./driver.mjs";

const query = (name) => join(here, "queries", name);

// What each piece of a text is at last: of captures of the same bytes the latest pattern counts.
function highlights(text) {
  const [captures] = ask([["query", query("highlights.scm"), { text }]]);
  const best = new Map();
  for (const [name, start, end, pattern] of captures) {
    const key = `${start} ${end}`;
    if (!best.has(key) || best.get(key).pattern <= pattern) best.set(key, { name, start, end, pattern });
  }
  return [...best.values()].sort((a, b) => a.start - b.start || b.end - a.end);
}

test("words, values and names are told apart", () => {
  const text = "scene 1\n/// doc\nlet gold = material conductor { eta = metal(\"Au\"), r = 5 cm }\n"
    + "@off shape sphere \"s\" { material = lib.gold }\n";
  const told = highlights(text).map(({ name, start, end }) => `${text.slice(start, end)}: ${name}`);
  assert.deepEqual(told.filter((line) => !/punctuation|operator/.test(line)), [
    "scene: keyword", "1: number", "/// doc: comment.documentation", "let: keyword", "gold: variable",
    "material: type", "conductor: constructor", "eta: property", "metal: function.call", "\"Au\": string",
    "r: property", "5: number", "cm: type.builtin", "@off: attribute", "shape: type", "sphere: constructor",
    "\"s\": label", "material: property", "lib: module", "gold: variable",
  ]);
});

test("every token of every scene is highlighted", () => {
  const nodes = parse(scenes.map(({ text }) => text));
  for (const [i, { name, text }] of scenes.entries()) {
    if (name.includes("bad_multi")) continue;
    const covered = new Uint8Array(Buffer.byteLength(text));
    for (const { start, end } of highlights(text)) covered.fill(1, start, end);
    for (const node of nodes[i].filter((node) => node.isLeaf)) {
      assert.ok(covered.subarray(node.start, node.end).every(Boolean), `${name}: ${node.type} at ${node.start}`);
    }
  }
});

test("every query can be read and captures something of a scene", () => {
  const text = scenes.find(({ name }) => name === "scenes/parametric.scene").text;
  const files = readdirSync(join(here, "queries"));
  assert.deepEqual(files.sort(), ["folds.scm", "highlights.scm", "indents.scm", "locals.scm", "tags.scm"]);
  const found = ask(files.map((file) => ["query", query(file), { text }]));
  for (const [i, captures] of found.entries()) assert.ok(captures.length > 10, files[i]);
});

test("definitions and references are found", () => {
  const text = "fn f(a: int) = a\nlet b = f(1)\nshape sphere \"s\" { }\n";
  const [tags] = ask([["query", query("tags.scm"), { text }]]);
  const told = tags.filter(([name]) => name === "name").map(([, start, end]) => text.slice(start, end));
  assert.deepEqual(told, ["f", "b", "f", "s"]);
});
