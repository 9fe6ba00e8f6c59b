// The cases of `test/corpus`, which `tree-sitter test` reads too, if it is installed.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { ask, here } from "./driver.mjs";

const folder = join(here, "test/corpus");

// Operators are fields without a name of their own; the cases leave them out, as the tool does.
const tidy = (tree) => tree.replace(/ operator: \("[^"]*"\)/g, "").replace(/\s+/g, " ").replace(/ \)/g, ")").trim();

for (const file of readdirSync(folder)) {
  const parts = readFileSync(join(folder, file), "utf8").split(/^=+\n(.*)\n=+\n/m).slice(1);
  for (let i = 0; i < parts.length; i += 2) {
    test(`${file}: ${parts[i]}`, () => {
      const [text, expected] = parts[i + 1].split(/^---$/m);
      const [tree] = ask([["tree", { text: text.trimStart() }]]);
      assert.equal(tidy(tree), tidy(expected));
    });
  }
}
