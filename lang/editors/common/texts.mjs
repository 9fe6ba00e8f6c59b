// Every text in the scene language that the project holds, and what the grammar of record says of it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { join, relative, resolve } from "node:path";

export const root = resolve(import.meta.dirname, "../../..");

const LEFT_OUT = new Set(["target", "node_modules", ".git", "out"]);

// Files of the project whose names end in one of `endings`.
function files(folder, endings) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return LEFT_OUT.has(entry.name) ? [] : files(path, endings);
    return entry.isFile() && endings.some((ending) => entry.name.endsWith(ending)) ? [path] : [];
  });
}

// Scene files, each as { name, text }.
export const scenes = files(root, [".scene"]).map(read);

// Snippets of manuals and of doc comments: what stands between ```scene and ```.
export const snippets = files(root, [".md", ".rs"]).flatMap((path) => {
  const { name, text } = read(path);
  const found = [];
  let lines = null;
  for (const [i, line] of text.split("\n").entries()) {
    const bare = line.replace(/^\s*\/\/[/!] ?/, "");
    if (lines === null) lines = bare.trim() === "```scene" ? [] : null;
    else if (bare.trim() === "```") {
      found.push({ name: `${name}:${i + 1 - lines.length}`, text: `${lines.join("\n")}\n` });
      lines = null;
    } else lines.push(bare);
  }
  return found;
});

// The cases of the language's tests, most of them wrong on purpose.
export const cases = files(join(root, "lang/tests/cases"), [".txt"]).flatMap((path) => {
  const { name, text } = read(path);
  const parts = text.split(/^--- (.*) ---$/m).slice(1);
  return Array.from({ length: parts.length / 2 }, (_, i) => ({
    name: `${name}: ${parts[2 * i]}`,
    text: parts[2 * i + 1].trimStart(),
  }));
});

assert.ok(scenes.length > 50 && snippets.length > 50 && cases.length > 100, "texts were not found");

function read(path) {
  return { name: relative(root, path), text: readFileSync(path, "utf8") };
}

// What pest makes of texts: { statements, tokens } as [rule, start, end, rule above] in bytes, or { error }.
export function pairs(texts) {
  // As the tests build it: of one package alone features differ, and all would be built again.
  execFileSync("cargo", ["build", "--quiet", "--workspace", "--example", "pairs"], { cwd: root });
  const built = resolve(root, process.env.CARGO_TARGET_DIR ?? "target", "debug/examples/pairs");
  const answer = execFileSync(built, {
    input: texts.map(({ text }) => `${text}\0`).join(""),
    maxBuffer: 1 << 28,
    stdio: ["pipe", "pipe", "inherit"],
  });
  const told = answer.toString().trim().split("\n").map((line) => JSON.parse(line));
  assert.equal(told.length, texts.length);
  return told;
}

// A text that is changed in chosen places: the same for the same seed.
export function random(seed) {
  let state = seed >>> 0;
  // Mulberry32.
  return (limit) => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t = (t + Math.imul(t ^ (t >>> 7), t | 61)) ^ t;
    return Math.floor((((t ^ (t >>> 14)) >>> 0) / 2 ** 32) * limit);
  };
}

// The words that a rule of the grammar of record lists.
export function words(rule) {
  const grammar = readFileSync(join(root, "lang/src/scene.pest"), "utf8");
  const body = new RegExp(`^${rule} *= *_?@?\\{ *\\(([^)]*)\\)`, "m").exec(grammar);
  assert.ok(body, `scene.pest has no list ${rule}`);
  return [...body[1].matchAll(/"([^"]+)"/g)].map(([, word]) => word).sort();
}
