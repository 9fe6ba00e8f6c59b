// Scopes of snippets to the letter, and of every scene against the grammar of record.

import assert from "node:assert/strict";
import { test } from "node:test";
import { pairs, scenes, snippets, words } from "../../common/texts.mjs";
import { tokens } from "./textmate.mjs";

// What a snippet's words are, each as `text: innermost scope`, blanks left out.
function check(text, expected) {
  const told = tokens(text)
    .filter((token) => token.text.trim() !== "" && token.scopes.length > 0)
    .map((token) => `${token.text}: ${token.scopes.at(-1)}`);
  assert.deepEqual(told, expected);
}

test("a header, a doc comment and a definition", () => {
  check("scene 1\n//! file\n/// doc\n//// no doc\nlet gold: length = 5 cm // end", [
    "scene: keyword.control.header", "1: constant.numeric.version", "//! file: comment.line.documentation.file",
    "/// doc: comment.line.documentation", "//// no doc: comment.line.double-slash", "let: storage.type",
    "gold: variable.other.definition", ":: punctuation.separator", "length: entity.name.type.value",
    "=: keyword.operator", "5: constant.numeric", "cm: keyword.other.unit", "// end: comment.line.double-slash",
  ]);
});

test("objects, their kinds and labels", () => {
  check("@off shape lib.sphere \"a\\n\" { r = -1 }", [
    "@off: entity.other.attribute-name", "shape: entity.name.type.category", "lib.sphere: support.class.kind",
    "\": string.quoted.double.label", "a: string.quoted.double.label", "\\n: constant.character.escape",
    "\": string.quoted.double.label", "r: variable.other.property", "=: keyword.operator", "-: keyword.operator",
    "1: constant.numeric",
  ]);
});

test("a word before the brace of a condition is no object", () => {
  check("if night { group { } } else { }", [
    "if: keyword.control", "night: variable.other", "group: entity.name.type.category", "else: keyword.control",
  ]);
  check("for i in xs { f() }", [
    "for: keyword.control", "i: variable.other", "in: keyword.control", "xs: variable.other",
    "f: entity.name.function.call",
  ]);
});

test("units after numbers and brackets, and only there", () => {
  check("a = (0, 1) W/m^2/sr\nb = 5 m/x\nc = f(1)\nd = 2", [
    "a: variable.other.property", "=: keyword.operator", "0: constant.numeric", ",: punctuation.separator",
    "1: constant.numeric", "): punctuation.section.brackets.end", "W/m^2/sr: keyword.other.unit",
    "b: variable.other.property", "=: keyword.operator", "5: constant.numeric", "m: keyword.other.unit",
    "/: keyword.operator", "x: variable.other", "c: variable.other.property", "=: keyword.operator",
    "f: entity.name.function.call", "1: constant.numeric", "d: variable.other.property", "=: keyword.operator",
    "2: constant.numeric",
  ]);
});

test("tables, ranges and expectations", () => {
  check("#[ 1 -2.5 ] mm", [
    "#[: punctuation.section.table.begin", "1: constant.numeric", "-2.5: constant.numeric",
    "]: punctuation.section.table.end", "mm: keyword.other.unit",
  ]);
  check("expect mean = 0..=1 ± 1e-3 where { a = true }", [
    "expect: keyword.other", "mean: support.function.expectation", "=: keyword.operator", "0: constant.numeric",
    "..=: keyword.operator", "1: constant.numeric", "±: keyword.operator", "1e-3: constant.numeric",
    "where: keyword.other", "a: variable.other.property", "=: keyword.operator", "true: constant.language.boolean",
  ]);
});

test("functions and what a file takes from elsewhere", () => {
  check("fn f(a: length[2]) = a\nimport \"b\" as n\nuse plugin \"p\" version \"1\"\nset l.x = 1\nplace t \"u\"", [
    "fn: storage.type", "f: entity.name.function", "(: punctuation.section.parens.begin", "a: variable.parameter",
    ":: punctuation.separator", "length[2]: entity.name.type.value", "): punctuation.section.parens.end",
    "=: keyword.operator", "a: variable.other", "import: keyword.control.import", "\": string.quoted.double",
    "b: string.quoted.double", "\": string.quoted.double", "as: keyword.control.import",
    "n: entity.name.namespace", "use: keyword.control.import", "plugin: keyword.control.import",
    "\": string.quoted.double", "p: string.quoted.double", "\": string.quoted.double",
    "version: keyword.control.import", "\": string.quoted.double", "1: string.quoted.double",
    "\": string.quoted.double", "set: keyword.other", "l.x: variable.other.object", "=: keyword.operator",
    "1: constant.numeric", "place: keyword.other", "t: variable.other.object",
    "\": string.quoted.double.label", "u: string.quoted.double.label", "\": string.quoted.double.label",
  ]);
});

test("a string that does not end costs its line alone", () => {
  check("a = \"abc\nb = \"\\q\"", [
    "a: variable.other.property", "=: keyword.operator", "\": string.quoted.double", "abc: string.quoted.double",
    "b: variable.other.property", "=: keyword.operator", "\": string.quoted.double", "\\q: invalid.illegal.escape",
    "\": string.quoted.double",
  ]);
});

test("words of the language and units are those of the grammar of record", () => {
  for (const word of words("keyword").filter((word) => word !== "where")) {
    const [{ scopes }] = tokens(`${word} `);
    assert.match(scopes.at(-1), /^(keyword|storage\.type|constant\.language)/, word);
    const after = tokens(`5 ${word} `).find((token) => token.text === word);
    assert.ok(!after.scopes.includes("keyword.other.unit"), `5 ${word}`);
  }
  for (const unit of words("known_unit")) {
    assert.equal(tokens(`5 W/${unit}^2 + a`)[2].text, `W/${unit}^2`);
  }
});

// What a token of the grammar of record, and what it stands in, must be; null: not told apart.
function expected(rule, above, text) {
  if (rule.startsWith("kw_")) return /^(keyword\.(control|other)|storage\.type)/;
  if (rule === "string") return ["obj_head", "place_stmt"].includes(above) ? /^string\..*label|^const/ : /^(string|const)/;
  if (rule === "ident") return name(above, text);
  return {
    unsigned: /^constant\.numeric/, version: /^constant\.numeric\.version/, unit: /^keyword\.other\.unit/,
    kind: /^support\.class\.kind/, doc: /^comment\.line\.documentation$/, attr: /^entity\.other\.attribute-name/,
    dangling_doc: /^comment\.line\.documentation$/, infix: /^keyword\.operator/, prefix: /^keyword\.operator/,
    pm: /^keyword\.operator/, eq: /^keyword\.operator/, colon: /^punctuation\.separator/,
    ty: /^entity\.name\.type\.value/, bulk_data: /^(meta\.table|constant\.numeric|punctuation)/,
  }[rule] ?? null;
}

function name(above, text) {
  if (["true", "false"].includes(text)) return /^constant\.language\.boolean/;
  return {
    obj_head: /^entity\.name\.type\.category/, field: /^variable\.other\.property/, arg: /^variable\.other\.property/,
    let_stmt: /^variable\.other\.definition/, param_stmt: /^variable\.other\.definition/,
    fn_def: /^entity\.name\.function/, fn_param: /^variable\.parameter/, import_stmt: /^entity\.name\.namespace/,
    expect_stmt: /^support\.function\.expectation/, ty: /^entity\.name\.type\.value/,
  }[above] ?? /^(variable\.other(\.object)?|entity\.name\.function\.call)$/;
}

test("tokens of every scene and snippet are what the grammar of record says", () => {
  const texts = [...scenes, ...snippets];
  const seen = new Map();
  const wrong = [];
  for (const [i, told] of pairs(texts).entries()) {
    if (told.error !== undefined) continue;
    const { name, text } = texts[i];
    const bytes = Buffer.from(text);
    const own = tokens(text);
    // Of each character its token, and whether a comment or a token of pest covers it.
    const at = new Array(text.length);
    for (const token of own) at.fill(token, token.start, token.end);
    const comment = own.filter(({ scopes }) => scopes[0]?.startsWith("comment"));
    const covered = new Uint8Array(text.length);
    for (const { start, end } of comment) covered.fill(1, start, end);
    for (const [rule, from, to, above] of told.tokens) {
      const start = bytes.subarray(0, from).toString().length;
      const written = bytes.subarray(from, to).toString();
      const wanted = expected(rule, above, written);
      if (rule !== "bulk_data" && rule !== "nums") covered.fill(1, start, start + written.length);
      if (rule === "bulk_data" || wanted === null) continue;
      seen.set(`${rule} in ${above}`, (seen.get(`${rule} in ${above}`) ?? 0) + 1);
      for (let j = start; j < start + written.length; j += 1) {
        const scope = at[j]?.scopes.at(-1) ?? "nothing";
        if (!wanted.test(scope)) {
          wrong.push(`${name}: ${rule} in ${above} \`${written.slice(0, 40)}\` is ${scope}`);
          break;
        }
      }
    }
    // What is neither comment nor token of pest holds no words: no comment was overlooked.
    const left = [...text.matchAll(/[\p{L}_"@]+/gu)].filter((match) => !covered[match.index]);
    const amid = left.filter((match) => !told.tokens.some(([rule, from, to]) =>
      ["bulk_data", "nums"].includes(rule) && from <= Buffer.byteLength(text.slice(0, match.index))
        && Buffer.byteLength(text.slice(0, match.index)) < to));
    wrong.push(...amid.filter((match) => match[0] !== "scene").map((match) => `${name}: \`${match[0]}\` is nothing`));
  }
  assert.deepEqual(wrong, []);
  const total = [...seen.values()].reduce((sum, n) => sum + n, 0);
  assert.ok(total > 10000, `only ${total} tokens`);
  for (const rule of ["kind in obj_head", "unit in quantity", "string in obj_head", "attr in stmt", "ident in fn_param"]) {
    assert.ok(seen.has(rule), `${rule} was never seen: ${[...seen.keys()]}`);
  }
});
