// The parser, compiled with tree-sitter's library by the C compiler, and asked by way of `driver.c`.

import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

export const here = resolve(import.meta.dirname, "..");
const library = join(here, "node_modules/tree-sitter/vendor/tree-sitter/lib");
const program = join(here, "build/driver");

let isBuilt = false;

function build() {
  if (isBuilt) return;
  mkdirSync(join(here, "build"), { recursive: true });
  const own = ["test/driver.c", "src/parser.c", "src/scanner.c"].map((file) => join(here, file));
  const include = ["include", "src"].map((folder) => `-I${join(library, folder)}`);
  const warnings = ["-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter"];
  const cc = process.env.CC ?? "cc";
  const object = join(here, `build/lib-${process.pid}.o`);
  const made = `${program}-${process.pid}`;
  execFileSync(cc, ["-O1", "-w", "-D_GNU_SOURCE", ...include, "-c", join(library, "src/lib.c"), "-o", object]);
  // Our own C is held to more than the library's.
  execFileSync(cc, ["-std=c11", "-O1", ...warnings, "-fsanitize=undefined", "-fno-sanitize-recover",
    `-I${join(here, "src")}`, include[0], ...own, object, "-o", made]);
  execFileSync("mv", [made, program]);
  rmSync(object);
  isBuilt = true;
}

// Answers to requests, each a list of words; `{ text }` stands for a file that holds the text.
export function ask(requests) {
  build();
  const folder = mkdtempSync(join(tmpdir(), "luxel-tree-sitter-"));
  let n = 0;
  const word = (given) => {
    if (given.text === undefined) return String(given);
    const path = join(folder, `${(n += 1)}.scene`);
    writeFileSync(path, given.text);
    return path;
  };
  const input = requests.map((request) => `${request.map(word).join("\t")}\n`).join("");
  const options = { input, maxBuffer: 1 << 29, stdio: ["pipe", "pipe", "inherit"] };
  const answer = execFileSync(program, options).toString();
  rmSync(folder, { recursive: true });
  return answer.trim().split("\n").map((line) => JSON.parse(line));
}

// The nodes of texts, in the order of the text, parents first.
export function parse(texts) {
  return ask(texts.map((text) => ["parse", { text }])).map((nodes) =>
    nodes.map(([type, named, start, end, depth, isError, isMissing], i) => ({
      type, named: named === 1, start, end, depth,
      isLeaf: i + 1 === nodes.length || nodes[i + 1][4] <= depth,
      isWrong: isError === 1 || isMissing === 1,
    })));
}
