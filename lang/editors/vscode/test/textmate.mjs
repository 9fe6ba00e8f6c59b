// The extension's TextMate grammar, read as VS Code reads it.

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";

const require = createRequire(import.meta.url);
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

export const here = resolve(import.meta.dirname, "..");
const path = resolve(here, "syntaxes/luxel-scene.tmLanguage.json");

await oniguruma.loadWASM(readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm")));
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async (scope) =>
    scope === "source.luxel-scene" ? textmate.parseRawGrammar(readFileSync(path, "utf8"), path) : null,
});
const grammar = await registry.loadGrammar("source.luxel-scene");

// The tokens of a text: { start, end, text, scopes }, places in characters.
export function tokens(text) {
  const found = [];
  let state = textmate.INITIAL;
  let at = 0;
  for (const line of text.split("\n")) {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, state);
    for (const { startIndex, endIndex, scopes } of tokens) {
      const [start, end] = [at + startIndex, at + Math.min(endIndex, line.length)];
      const own = scopes.slice(1).map((scope) => scope.replace(/\.luxel-scene$/, ""));
      if (end > start) found.push({ start, end, text: text.slice(start, end), scopes: own });
    }
    state = ruleStack;
    at += line.length + 1;
  }
  return found;
}
