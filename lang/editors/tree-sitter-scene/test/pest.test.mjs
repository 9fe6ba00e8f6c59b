// Against the grammar of record, on every text of the project.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { cases, pairs, random, scenes, snippets, words } from "../../common/texts.mjs";
import { ask, here, parse } from "./driver.mjs";

// Statements: pest's name and ours.
const STATEMENTS = {
  field: "field", object: "object", call_stmt: "call_statement", let_stmt: "let_statement",
  param_stmt: "param_statement", fn_def: "fn_statement", for_stmt: "for_statement",
  if_stmt: "if_statement", include_stmt: "include_statement", import_stmt: "import_statement",
  use_stmt: "use_statement", place_stmt: "place_statement", set_stmt: "set_statement",
  assert_stmt: "assert_statement", expect_stmt: "expect_statement", unit_stmt: "units_statement",
};

const RESERVED = ["let", "param", "fn", "for", "if", "else", "include", "import", "use", "place", "set", "assert",
  "expect", "units", "with", "as", "in"];

// Tokens: pest's name and ours. Pest reads a literal list at once.
const TOKENS = {
  doc: "doc", attr: "attribute", version: "version", kind: "kind", unit: "unit", string: "string",
  unsigned: "number", ident: "identifier", infix: null, prefix: null, eq: "=", colon: ":",
  pm: null, ty: "type", nums: null, bulk_data: null, comma: null, EOI: null,
  // What is empty between its brackets.
  block: null, record: null, call: null, list: null, str_body: null,
};

const told = pairs([...scenes, ...snippets, ...cases]);
const texts = [...scenes, ...snippets, ...cases].map((given, i) => ({ ...given, ...told[i] }));
const trees = parse(texts.map(({ text }) => text));
const good = texts.map((given, i) => ({ ...given, nodes: trees[i] })).filter(isRight);

// Pest leaves it to the tree's builder to refuse words of the language as names.
function isRight({ text, error, tokens }) {
  const bytes = Buffer.from(text);
  return error === undefined && !tokens.some(([rule, start, end]) =>
    rule === "ident" && RESERVED.includes(bytes.subarray(start, end).toString()));
}

// The end without the blanks and comments that pest counts as part of a statement.
function trimmed(given, end) {
  const comments = given.nodes.filter((node) => node.type === "comment");
  const bytes = Buffer.from(given.text);
  for (;;) {
    while (" \t\r\n".includes(String.fromCharCode(bytes[end - 1]))) end -= 1;
    const comment = comments.find((node) => node.end === end);
    if (!comment) return end;
    end = comment.start;
  }
}

// Statements stand in a file or block; fields stand in records too, which are expressions.
function statements(nodes) {
  const parents = [];
  const found = [];
  for (const node of nodes) {
    parents.length = node.depth;
    const parent = parents.at(-1);
    if (["source_file", "block"].includes(parent) && Object.values(STATEMENTS).includes(node.type)) {
      found.push([node.type, node.start, node.end]);
    }
    parents.push(node.type);
  }
  return found;
}

test("every scene of the project is accepted by pest, but for the one with mistakes", () => {
  const wrong = texts.slice(0, scenes.length).filter(({ error }) => error !== undefined);
  assert.deepEqual(wrong.map(({ name }) => name), ["lang/tests/scenes/bad_multi.scene"]);
});

test("what pest accepts has no mistake", () => {
  const wrong = good.filter(({ nodes }) => nodes.some((node) => node.isWrong));
  assert.deepEqual(wrong.map(({ name }) => name), []);
  assert.ok(good.length > 150, `only ${good.length} texts are right`);
});

test("statements begin and end where pest's do, and are of the same kind", () => {
  let n = 0;
  for (const given of good) {
    const expected = given.statements
      .map(([rule, start, end]) => [STATEMENTS[rule], start, trimmed(given, end)]);
    assert.deepEqual(statements(given.nodes), expected, given.name);
    n += expected.length;
  }
  assert.ok(n > 2000, `only ${n} statements`);
});

test("tokens are pest's", () => {
  const seen = new Set();
  for (const given of good) {
    const bytes = Buffer.from(given.text);
    const own = new Map(given.nodes.map((node) => [`${node.type} ${node.start} ${node.end}`, node]));
    for (const [rule, start, end] of given.tokens) {
      const text = bytes.subarray(start, end).toString();
      let type = rule.startsWith("kw_") ? text : TOKENS[rule];
      if (["infix", "prefix", "pm"].includes(rule)) type = text;
      if (rule === "ident" && ["true", "false"].includes(text)) type = "boolean";
      if (type === null) continue;
      seen.add(rule);
      assert.notEqual(type, undefined, `${given.name}: ${rule} is not known`);
      assert.ok(own.has(`${type} ${start} ${end}`), `${given.name}: ${type} \`${text}\` at ${start}`);
    }
  }
  for (const rule of ["kind", "unit", "unsigned", "string", "doc", "attr", "ident", "infix", "ty"]) {
    assert.ok(seen.has(rule), `${rule} was never seen`);
  }
});

test("numbers in literal lists are numbers", () => {
  let n = 0;
  for (const given of good) {
    for (const [, start, end] of given.tokens.filter(([rule]) => rule === "nums")) {
      const inside = given.nodes.filter((node) => node.isLeaf && node.start >= start && node.end <= end);
      const other = inside.filter(({ type }) => !["number", ",", "-", "+", "comment"].includes(type));
      assert.deepEqual(other, [], given.name);
      n += inside.filter(({ type }) => type === "number").length;
    }
  }
  assert.ok(n > 1000, `only ${n} numbers`);
});

test("the lists of words and units are pest's", () => {
  const scanner = readFileSync(join(here, "src/scanner.c"), "utf8");
  const list = (name) => {
    const [, body] = new RegExp(`${name}\\[\\] = \\{([^}]*)\\}`).exec(scanner);
    return [...body.matchAll(/"([^"]+)"/g)].map(([, word]) => word.replace("~", "µ")).sort();
  };
  assert.deepEqual(list("KEYWORDS"), words("keyword"));
  assert.deepEqual(list("UNITS"), words("known_unit"));
  const grammar = readFileSync(join(here, "grammar.js"), "utf8");
  const [, reserved] = /words: \(\) => \[([^\]]*)\]/.exec(grammar);
  const own = [...reserved.matchAll(/"([^"]+)"/g)].map(([, word]) => word).sort();
  assert.deepEqual(own, [...words("reserved"), "true", "false"].sort());
});

test("after a mistake the parser goes on", () => {
  const bad = texts.map((given, i) => ({ ...given, nodes: trees[i] })).filter(({ error }) => error !== undefined);
  assert.ok(bad.length > 20, `only ${bad.length} texts are wrong`);
  // A mistake in one line amid a scene costs none of the statements at its end.
  const tail = "\n\nlet after = 1\nshape sphere \"last\" { radius = 1 m }\n";
  const lines = ["let a = (0, 1 0)", "shape sphere { radius 5 cm }", "let let = 1", "fn f(a) = a", "radius: 5 cm",
    "let a = 1.2.3", "let c = = 5", "else { let b = 3 }", "let a = 5 +", "let s = \"abc", "let a ="];
  const found = parse(lines.map((line) => `scene 1\nlet before = 1\n${line}${tail}`));
  for (const [i, nodes] of found.entries()) {
    assert.ok(nodes.some((node) => node.isWrong), `no mistake was found in: ${lines[i]}`);
    const length = Buffer.byteLength(`scene 1\nlet before = 1\n${lines[i]}\n\nlet after = 1\n`);
    const last = nodes.find((node) => node.type === "object" && node.start === length);
    assert.ok(last, `the last object was lost after: ${lines[i]}`);
  }
});

// Scenes with a few bytes taken out, put in or doubled, the same for the same seed.
function damaged(n, seed) {
  const below = random(seed);
  const pieces = ["", "{", "}", "\"", " m", "5", "// ", "/*", " a ", "= ", "\n", "-", "(", ")", ",", ".", "[", "]"];
  return Array.from({ length: n }, () => {
    const old = scenes[below(scenes.length)].text.slice(0, 2000);
    const from = below(old.length);
    const to = Math.min(old.length, from + below(8));
    const text = old.slice(0, from) + pieces[below(pieces.length)] + old.slice(to);
    return { name: `damaged at ${from}`, old, from, to, text };
  });
}

test("of damaged scenes, those that pest accepts have the same statements", () => {
  const given = damaged(600, 7).filter(({ text }) => text.startsWith("scene 1") || text.includes("\nscene 1\n"));
  const read = pairs(given);
  const nodes = parse(given.map(({ text }) => text));
  let n = 0;
  for (const [i, told] of read.entries()) {
    if (!isRight({ ...given[i], ...told })) continue;
    const one = { ...given[i], nodes: nodes[i] };
    assert.ok(!one.nodes.some((node) => node.isWrong), one.text);
    const expected = told.statements.map(([rule, start, end]) => [STATEMENTS[rule], start, trimmed(one, end)]);
    assert.deepEqual(statements(one.nodes), expected, one.text);
    n += 1;
  }
  assert.ok(n > 50, `only ${n} are right`);
});

test("edits give what reading anew gives", () => {
  // Bytes and characters are the same where only ASCII stands.
  const given = damaged(400, 20261122).filter(({ old }) => !/[^\x00-\x7f]/.test(old));
  const same = ask(given.map(({ old, from, to, text }) => ["edit", { text: old }, from, to, { text }]));
  assert.ok(same.length > 200);
  assert.deepEqual(given.filter((_, i) => !same[i]).map(({ name }) => name), []);
});
