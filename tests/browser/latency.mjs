// How soon a browser shows what was saved. By hand:
//
//   cargo build --release && cd tests/browser && npm ci && LUXEL=../../target/release/luxel node latency.mjs
//
// LUXEL and CHROMIUM as for run.mjs; EDITS is how many of each kind.

import { spawn } from "node:child_process";
import { mkdtempSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";

const root = resolve(import.meta.dirname, "../..");
const luxel = resolve(process.env.LUXEL ?? join(root, "target/release/luxel"));
const folder = mkdtempSync(join(tmpdir(), "luxel-latency-"));
const file = join(folder, "a.scene");
const EDITS = Number(process.env.EDITS ?? 40);
const SIZE = [960, 540];
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

const scene = ({ z = 3, rho = 0.5, x = 0 }) => `scene 1
camera perspective { look = look_at(from = (0, 2, ${z}) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (${SIZE.join(", ")}) }
sampler sobol { samples = 4096 }
light constant { radiance = 0.5 W/m^2/sr }
shape sphere { radius = 50 cm, transform = move((${x}, 0.5, 0) m), material = material diffuse { reflectance = ${rho} } }
shape rectangle { u = (4, 0, 0) m, v = (0, 0, -4) m }
`;
const edits = {
  camera: (n) => ({ z: 3 + 0.01 * n }),
  material: (n) => ({ rho: 0.3 + 0.01 * n }),
  transform: (n) => ({ x: 0.01 * n }),
};

function save(text) {
  writeFileSync(`${file}.part`, text);
  const at = Date.now();
  renameSync(`${file}.part`, file);
  return at;
}

// When each edit was on the screen: in the frame after the one in which it was drawn.
const watched = () => {
  window.seen = new Map();
  const canvas = document.getElementById("picture");
  new MutationObserver(() => {
    const generation = Number(canvas.dataset.generation);
    if (window.seen.has(generation)) return;
    window.seen.set(generation, NaN);
    requestAnimationFrame(() => window.seen.set(generation, Date.now()));
  }).observe(canvas, { attributeFilter: ["data-generation"] });
};
const latest = (page) => page.evaluate(() => [...window.seen].filter(([, at]) => at > 0).at(-1) ?? [0, 0]);

save(scene({}));
const child = spawn(luxel, ["watch", file, "--preview", "--no-open", "--quiet", "-o", join(folder, "out")], { stdio: ["ignore", "ignore", "pipe"] });
const url = await new Promise((done, failed) => {
  createInterface(child.stderr).on("line", (line) => line.includes("preview: ") && done(line.split("preview: ")[1].trim()));
  child.once("exit", (code) => failed(new Error(`luxel watch ended with ${code}`)));
});
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  const page = await browser.newPage({ viewport: { width: 1024, height: 640 } });
  await page.goto(url);
  await page.evaluate(watched);
  const times = Object.fromEntries(Object.keys(edits).map((kind) => [kind, []]));
  await pause(2000);
  for (let n = 1; n <= EDITS; n++) {
    for (const [kind, edit] of Object.entries(edits)) {
      await pause(150 + 200 * Math.random());
      const [before] = await latest(page);
      const saved = save(scene(edit(n)));
      // Asking often would slow down what is measured.
      for (let tries = 0; ; tries++) {
        await pause(250);
        const [generation, at] = await latest(page);
        if (generation > before) {
          times[kind].push(at - saved);
          break;
        }
        if (tries > 40) throw new Error(`an edit of the ${kind} was not drawn`);
      }
    }
  }
  const of = (ms, percent) => ms[Math.ceil((ms.length * percent) / 100) - 1];
  console.log(`save to drawn in the browser, ${SIZE.join(" x ")}, ms (goal: p95 100)`);
  for (const [kind, unsorted] of Object.entries(times)) {
    const ms = unsorted.toSorted((a, b) => a - b);
    console.log(`${kind.padEnd(10)} n ${ms.length}  p50 ${of(ms, 50)}  p95 ${of(ms, 95)}  p99 ${of(ms, 99)}`);
  }
} finally {
  await browser.close();
  child.kill("SIGINT");
  rmSync(folder, { recursive: true, force: true });
}
