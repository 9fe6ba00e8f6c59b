// The search of `luxel docs`, without a browser: what a query finds, in which order, and what is said of one
// that finds nothing. LUXEL_DOCS is the folder of a reference site, whose search.js holds its pages too; without it
// the program's script is run over a few made-up pages.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { test } from "node:test";
import { runInNewContext } from "node:vm";

const SCRIPT = resolve(import.meta.dirname, "../../cli/src/docs/search.js");

const PAGES = [
  { page: "shape-sphere.html", title: "shape sphere", summary: "A ball.", words: "A ball. radius center how far it reaches" },
  { page: "shape-sphere.html#radius", title: "radius · shape sphere", summary: "shape sphere", words: "From the centre to the surface." },
  { page: "shape-hemisphere.html", title: "shape hemisphere", summary: "Half a ball.", words: "As sphere, cut in two." },
  { page: "material-conductor.html", title: "material conductor", summary: "A metal.", words: "eta roughness" },
  { page: "material-conductor.html#roughness", title: "roughness · material conductor", summary: "material conductor", words: "How matt it is." },
  { page: "language.html", title: "The scene language", summary: "All of it.", words: "a sphere has a radius, a box has none ".repeat(9) },
];

// What stands for an element of the page: as much of it as the script uses.
class Element {
  constructor(name) {
    Object.assign(this, { name, children: [], handlers: {}, value: "", hidden: true, href: "", textContent: "" });
  }
  append(...more) { this.children.push(...more); }
  replaceChildren(...all) { this.children = all; }
  addEventListener(event, handler) { this.handlers[event] = handler; }
  focus() { this.isFocused = true; }
  querySelector(name) {
    const inner = this.children.filter((child) => child instanceof Element);
    return inner.map((child) => (child.name === name ? child : child.querySelector(name))).find(Boolean) ?? null;
  }
}

// The page with its field: `query` gives the links that are shown, or the text that stands in their place.
function site(text) {
  const ids = { search: new Element("input"), found: new Element("ul") };
  const document = Object.assign(new Element("document"), {
    getElementById: (id) => ids[id],
    createElement: (name) => new Element(name),
    activeElement: null,
  });
  const location = { href: "" };
  runInNewContext(text, { document, location });
  const query = (words) => {
    ids.search.value = words;
    ids.search.handlers.input();
    return ids.found.children.map((item) => (item instanceof Element ? item.querySelector("a").href : item));
  };
  return { query, ids, document, location };
}

const made = () => site(`const PAGES = ${JSON.stringify(PAGES)};\n${readFileSync(SCRIPT, "utf8")}`);

test("the name of a parameter finds the plugin that has it", () => {
  const { query } = made();
  assert.equal(query("roughness")[0], "material-conductor.html#roughness");
  assert.ok(query("roughness").includes("material-conductor.html"));
  assert.ok(query("radius").includes("shape-sphere.html"));
  assert.deepEqual(query("conductor eta"), ["material-conductor.html"]);
});

test("a whole name stands before a part of one, and a title before a text", () => {
  const found = made().query("sphere");
  assert.equal(found[0], "shape-sphere.html");
  assert.ok(found.indexOf("shape-sphere.html") < found.indexOf("shape-hemisphere.html"), `${found}`);
  const radius = made().query("RADIUS");
  assert.equal(radius[0], "shape-sphere.html#radius");
  assert.ok(radius.indexOf("shape-sphere.html") >= 0 && radius.includes("language.html"), `${radius}`);
});

test("what is nowhere is said to be nowhere, and an empty field shows nothing", () => {
  const { query, ids } = made();
  assert.deepEqual(query("zzyzx"), ["nothing is called that"]);
  assert.equal(ids.found.hidden, false);
  // Every word must be found.
  assert.deepEqual(query("radius zzyzx"), ["nothing is called that"]);
  assert.deepEqual(query("  "), []);
  assert.equal(ids.found.hidden, true);
});

test("Enter leads to the first that was found, and a slash to the field", () => {
  const { query, ids, document, location } = made();
  query("zzyzx");
  ids.search.handlers.keydown({ key: "Enter" });
  assert.equal(location.href, "");
  query("radius");
  ids.search.handlers.keydown({ key: "Enter" });
  assert.equal(location.href, "shape-sphere.html#radius");
  let isKept = false;
  document.handlers.keydown({ key: "/", preventDefault: () => { isKept = true; } });
  assert.ok(isKept && ids.search.isFocused);
});

test("no more than twelve are shown", () => {
  const pages = Array.from({ length: 30 }, (_, i) => ({ page: `${i}.html`, title: `ball ${i}`, summary: "", words: "" }));
  const { query } = site(`const PAGES = ${JSON.stringify(pages)};\n${readFileSync(SCRIPT, "utf8")}`);
  assert.equal(query("ball").length, 12);
});

test("the site that the program writes", { skip: !process.env.LUXEL_DOCS && "LUXEL_DOCS names no site" }, () => {
  const { query } = site(readFileSync(join(process.env.LUXEL_DOCS, "search.js"), "utf8"));
  assert.equal(query("sphere")[0], "shape-sphere.html");
  assert.ok(query("fov_axis").some((page) => page.startsWith("camera-perspective.html")), `${query("fov_axis")}`);
  assert.ok(query("sphere radius").some((page) => page.startsWith("shape-sphere.html")), `${query("sphere radius")}`);
  assert.deepEqual(query("zzyzx"), ["nothing is called that"]);
});
