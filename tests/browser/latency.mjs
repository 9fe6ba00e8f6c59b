// How soon a browser shows what was saved. By hand:
//
//   cargo build --release && cd tests/browser && npm ci && LUXEL=../../target/release/luxel node latency.mjs
//
// LUXEL and CHROMIUM as for view.mjs; EDITS is how many of each kind.

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

// A wavy ball of so many rows and columns as PLY: 2 rows × columns triangles.
function ball(rows, columns) {
  const points = (rows + 1) * columns, faces = 2 * rows * columns;
  const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${points}\nproperty float x\nproperty float y\nproperty float z\nelement face ${faces}\nproperty list uchar int vertex_indices\nend_header\n`;
  const bytes = Buffer.alloc(head.length + points * 12 + faces * 13);
  let at = bytes.write(head, "latin1");
  for (let i = 0; i <= rows; i++) for (let j = 0; j < columns; j++) {
    const theta = (Math.PI * (i + 0.5)) / (rows + 1), phi = (2 * Math.PI * j) / columns, r = 0.5 + 0.02 * Math.sin(9 * phi) * Math.sin(9 * theta);
    for (const v of [r * Math.sin(theta) * Math.cos(phi), r * Math.cos(theta), r * Math.sin(theta) * Math.sin(phi)]) at = bytes.writeFloatLE(v, at);
  }
  for (let i = 0; i < rows; i++) for (let j = 0; j < columns; j++) {
    const a = i * columns + j, b = i * columns + ((j + 1) % columns);
    for (const face of [[a, b, a + columns], [b, b + columns, a + columns]]) {
      at = bytes.writeUInt8(3, at);
      for (const corner of face) at = bytes.writeInt32LE(corner, at);
    }
  }
  return bytes;
}
// A picture of 2 × 2 pixels, Radiance: mantissas and an exponent of 1.
const picture = (n) => Buffer.concat([Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n"), Buffer.from([0, 1, 2, 3].flatMap((i) => [40 + (n + i * 50) % 200, 90, 60, 128]))]);
const triangle = (n) => Buffer.from(`v -1 0 0\nv 1 0 0\nv 0 ${1 + 0.01 * n} 0\nf 1 2 3\n`);

const scene = ({ z = 3, rho = 0.5, x = 0, comment = "" }) => `scene 1 // ${comment}
camera perspective { look = look_at(from = (0, 2, ${z}) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (${SIZE.join(", ")}) }
sampler sobol { samples = 4096 }
light constant { radiance = 0.5 W/m^2/sr }
shape mesh { file = "ball.ply", unit = 1 m, transform = move((${x}, 0.5, 0) m), material = material diffuse { reflectance = ${rho} } }
shape mesh { file = "small.obj", unit = 1 m, transform = move((0, 0, -1.5) m) }
shape rectangle { u = (4, 0, 0) m, v = (0, 0, -4) m, material = material diffuse { reflectance = texture image { file = "paint.hdr" } } }
`;
const edits = {
  camera: (n) => ["a.scene", scene({ z: 3 + 0.01 * n })],
  material: (n) => ["a.scene", scene({ rho: 0.3 + 0.01 * n })],
  transform: (n) => ["a.scene", scene({ x: 0.01 * n })],
  texture: (n) => ["paint.hdr", picture(n)],
  mesh: (n) => ["small.obj", triangle(n)],
  // After the transform, so that the text is what it was but for the comment.
  comment: (n) => ["a.scene", scene({ x: 0.01 * n, comment: n })],
};

function save([name, text]) {
  const to = join(folder, name);
  writeFileSync(`${to}.part`, text);
  const at = Date.now();
  renameSync(`${to}.part`, to);
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

[["ball.ply", ball(708, 708)], ["paint.hdr", picture(0)], ["small.obj", triangle(0)], ["a.scene", scene({})]].forEach(save);
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
      const saved = save(edit(n));
      if (kind === "comment") {
        await pause(750);
        if ((await latest(page))[0] > before) throw new Error("a comment made another picture");
        continue;
      }
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
  console.log(`comment    n ${EDITS}  no other picture`);
  delete times.comment;
  for (const [kind, unsorted] of Object.entries(times)) {
    const ms = unsorted.toSorted((a, b) => a - b);
    console.log(`${kind.padEnd(10)} n ${ms.length}  p50 ${of(ms, 50)}  p95 ${of(ms, 95)}  p99 ${of(ms, 99)}`);
  }
} finally {
  await browser.close();
  child.kill("SIGINT");
  rmSync(folder, { recursive: true, force: true });
}
