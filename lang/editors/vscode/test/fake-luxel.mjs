#!/usr/bin/env node
// Behaves as `luxel watch --preview --json` does towards who starts it; its mood is in FAKE.

import { writeFileSync } from "node:fs";

const mood = process.env.FAKE ?? "well";
const given = process.argv.slice(2);
const output = given[given.indexOf("-o") + 1];
writeFileSync(`${output}.started`, JSON.stringify({ given, cwd: process.cwd() }));

// Before anything is told: who is told may end it at once.
process.on("SIGINT", () => {
  if (mood === "stubborn") return;
  console.error("watching has ended");
  process.exit(0);
});

if (mood === "refuses") {
  console.error("error: no such scene");
  process.exit(1);
}
if (mood === "slow") writeFileSync(`${output}.png`, "");
console.error("preview: http://127.0.0.1:4711/?token=abc");
console.error(JSON.stringify({ severity: "error", message: "unknown kind", file: "a.scene", line: 2, column: 7 }));
console.error(JSON.stringify({ severity: "error", message: "no camera", file: "a.scene", line: null, column: null }));
console.error(JSON.stringify({ severity: "error", message: "a full disk", file: null, line: null, column: null }));
console.error(JSON.stringify({ severity: "warning", message: "not told" }));
if (mood !== "slow") console.log(JSON.stringify({ png: `${output}.png`, complete: true }));
console.log("no summary");
setInterval(() => {}, 1000);
