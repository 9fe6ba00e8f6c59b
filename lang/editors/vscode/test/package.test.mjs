// What the package promises and holds.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { test } from "node:test";
import { scenes } from "../../common/texts.mjs";

const here = resolve(import.meta.dirname, "..");
const json = (path) => JSON.parse(readFileSync(join(here, path), "utf8"));
const manifest = json("package.json");
const language = json("language-configuration.json");

test("commands and settings of the manifest are those of the source", () => {
  const source = ["extension", "preview", "program", "server"]
    .map((name) => readFileSync(join(here, `src/${name}.ts`), "utf8")).join("\n");
  for (const { command } of manifest.contributes.commands) {
    assert.ok(source.includes(`registerCommand("${command}"`), command);
  }
  for (const setting of Object.keys(manifest.contributes.configuration.properties)) {
    assert.ok(source.includes(`"${setting.replace("luxel.", "")}"`), setting);
  }
});

test("the packed extension holds what its manifest names, and nothing of the tests", () => {
  const held = execFileSync(join(here, "node_modules/.bin/vsce"), ["ls", "--no-dependencies"], { cwd: here, stdio: ["ignore", "pipe", "ignore"] })
    .toString().trim().split("\n").sort();
  assert.deepEqual(held, [
    "README.md", "dist/extension.js", "icons/scene.svg", "language-configuration.json", "package.json",
    "syntaxes/luxel-scene.tmLanguage.json",
  ]);
});

test("indentation of scenes is what the rules of indentation give", () => {
  const increase = new RegExp(language.indentationRules.increaseIndentPattern);
  const decrease = new RegExp(language.indentationRules.decreaseIndentPattern);
  const indent = (line) => line.length - line.trimStart().length;
  let n = 0;
  for (const { name, text } of scenes.filter(({ name }) => name.startsWith("scenes/"))) {
    const lines = text.split("\n").filter((line) => line.trim() !== "");
    for (const [i, line] of lines.slice(1).entries()) {
      const before = lines[i];
      if (increase.test(before) && !decrease.test(line)) {
        assert.ok(indent(line) > indent(before), `${name}: ${line}`);
        n += 1;
      } else if (decrease.test(line) && !increase.test(before)) {
        assert.ok(indent(line) < indent(before), `${name}: ${line}`);
        n += 1;
      }
    }
  }
  assert.ok(n > 100, `only ${n} lines`);
});

test("a new line after a doc comment continues it", () => {
  const [doc, file] = language.onEnterRules.map(({ beforeText }) => new RegExp(beforeText));
  assert.ok(doc.test("  /// text") && !doc.test("//// text") && !doc.test("// text"));
  assert.ok(file.test("//! text") && !file.test("// ! text"));
});
