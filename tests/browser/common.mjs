// What the browser tests share.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";

export const root = resolve(import.meta.dirname, "../..");
export const luxel = process.env.LUXEL ?? join(root, "target/debug/luxel");
export const shots = process.env.SHOTS ?? join(import.meta.dirname, "shots");
export const folder = mkdtempSync(join(tmpdir(), "luxel-browser-"));
mkdirSync(shots, { recursive: true });

export const WINDOW = { width: 560, height: 420 };

// A strict policy forbids predicates as strings: ask again until it is so.
export async function until(what, holds) {
  const since = Date.now();
  while (!(await holds())) {
    assert.ok(Date.now() - since < 20000, `waited in vain: ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

// The canvas's pixels that are covered by the picture, as { w, h, data }.
export const readback = (page, whole = true) => page.evaluate((whole) => {
  const from = document.getElementById("picture");
  const to = Object.assign(document.createElement("canvas"), { width: from.width, height: from.height });
  const context = to.getContext("2d", { willReadFrequently: true });
  context.drawImage(from, 0, 0);
  const { data } = context.getImageData(0, 0, to.width, to.height);
  const at = [];
  for (let i = 3; i < data.length; i += 4) if (data[i] === 255) at.push((i - 3) / 4);
  if (!at.length) return null;
  const xs = at.map((i) => i % to.width), ys = at.map((i) => Math.floor(i / to.width));
  const min = (all) => all.reduce((a, b) => Math.min(a, b)), max = (all) => all.reduce((a, b) => Math.max(a, b));
  const [x, y, w, h] = [min(xs), min(ys), max(xs) - min(xs) + 1, max(ys) - min(ys) + 1];
  return { x, y, w, h, data: whole ? [...context.getImageData(x, y, w, h).data] : [] };
}, whole);

export const decoded = (page, png) => page.evaluate(async (source) => {
  const image = new Image();
  image.src = source;
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  return [...context.getImageData(0, 0, image.width, image.height).data];
}, `data:image/png;base64,${readFileSync(png).toString("base64")}`);

export const text = (page, id) => page.evaluate((id) => document.getElementById(id).textContent, id);
export const isHidden = (page, id) => page.evaluate((id) => document.getElementById(id).hidden, id);
export const mean = (data) => data.reduce((sum, v) => sum + v, 0) / data.length;
export const settled = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

export async function press(page, key) {
  await page.keyboard.press(key);
  await settled(page);
}

// `before` is given the page before it loads anything.
export async function open(browser, url, { before = () => {}, ...options } = {}) {
  const context = await browser.newContext({ viewport: WINDOW, ...options });
  const page = await context.newPage();
  await before(page);
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(url);
  await until("a picture", () => isHidden(page, "empty"));
  await settled(page);
  return { page, complaints, close: () => context.close() };
}

// The program with these arguments, which ends with the tests at the latest: after one that failed nobody else ends it.
const programs = [];
export function started(args, options) {
  const child = spawn(luxel, args, options);
  programs.push(child);
  return child;
}

// `luxel view` of these pictures.
export async function view(...args) {
  const child = started(["view", ...args, "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((done, failed) => {
    child.stdout.once("data", (text) => done(String(text).trim()));
    child.once("exit", (code) => failed(new Error(`luxel view ended with ${code}`)));
  });
  return { url, port: new URL(url).port, token: new URL(url).searchParams.get("token"), end: () => child.kill("SIGINT") };
}

export const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true, colorScheme: "dark" };

// Everything that is touched is 40 pixels wide and high at least, and within a window of that width.
export async function roomy(page, where) {
  const small = await page.evaluate(() => {
    const wide = document.documentElement.scrollWidth > innerWidth ? ["the page is wider than its window"] : [];
    const all = [...document.querySelectorAll("button, select, #bar input, #rows input, #facts a")].filter((each) => each.checkVisibility({ visibilityProperty: true }));
    const of = (each) => (each.type === "checkbox" ? each.closest("label") : each).getBoundingClientRect();
    const bad = all.filter((each) => {
      const { width, height, left, right } = of(each);
      return width < 40 || height < 40 || left < 0 || right > innerWidth;
    });
    return [...wide, ...bad.map((each) => `${each.id || each.name || each.textContent} ${JSON.stringify(of(each))}`)];
  });
  assert.deepEqual(small, [], where);
}

// What a page of elsewhere tries, which knows the port and has stolen the token.
export async function attacked(browser, one) {
  const server = createServer((_, answer) => answer.setHeader("content-type", "text/html").end("<!doctype html>evil"));
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const page = await browser.newPage();
  await page.goto(`http://localhost:${server.address().port}/`);
  const tried = await page.evaluate(async ({ port, token }) => {
    const url = `http://127.0.0.1:${port}/main.js?token=${token}`;
    const socket = await new Promise((done) => {
      const socket = new WebSocket(`ws://127.0.0.1:${port}/ws?token=${token}`);
      socket.onopen = () => done("open");
      socket.onerror = () => done("refused");
    });
    const fetched = await fetch(url).then((answer) => answer.status, () => "refused");
    const blind = await fetch(url, { mode: "no-cors" }).then((answer) => answer.type, () => "refused");
    const script = await new Promise((done) => {
      const script = Object.assign(document.createElement("script"), { src: url, type: "module" });
      script.onload = () => done("loaded");
      script.onerror = () => done("refused");
      document.head.append(script);
    });
    return { socket, fetched, blind, script };
  }, { port: one.port, token: one.token });
  assert.deepEqual(tried, { socket: "refused", fetched: "refused", blind: "refused", script: "refused" });
  const codes = [];
  page.on("response", (answer) => codes.push(answer.status()));
  // An answer without a body is no page to the browser.
  await page.goto(`http://evil.test:${one.port}/?token=${one.token}`).catch(() => null);
  assert.deepEqual(codes, [421]);
  await page.close();
  server.close();
}

// Runs tests by name, those that the command line names a part of, and ends the browser and every program.
export async function run(tests, given) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP evil.test 127.0.0.1"],
  });
  let failed = 0;
  for (const [name, test] of Object.entries(tests)) {
    if (process.argv[2] && !name.includes(process.argv[2])) continue;
    const since = Date.now();
    try {
      await test({ browser, folder, ...given });
      console.log(`ok      ${name} (${Date.now() - since} ms)`);
    } catch (error) {
      failed += 1;
      console.log(`FAILED  ${name}\n${error.stack}`);
    }
  }
  await browser.close();
  programs.forEach((child) => child.kill("SIGINT"));
  rmSync(folder, { recursive: true });
  process.exitCode = failed ? 1 : 0;
}
