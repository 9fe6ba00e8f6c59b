// What the tests of `luxel watch --preview` share.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { decoded, folder, isHidden, luxel, open, press, readback, started, text, until } from "./common.mjs";

export const SIZE = [48, 32];
// Wide enough for panels beside the picture.
export const WINDOW = { width: 900, height: 560 };
const FEW = ["--spp", "4", "--seed", "7"];

export const scene = ({ grey = "0.5", params = "", radius = "1 m", camera = CAMERA } = {}) => `scene 1
${params}
${camera}
film rgb { resolution = (${SIZE.join(", ")}) }
light constant { scale = 0.8 }
let grey = material diffuse { reflectance = ${grey} }
shape sphere "ball" { radius = ${radius}, material = grey }
`;
export const CAMERA = "camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }";

let made = 0;
export async function watch(content, ...args) {
  const name = `w${made++}`, file = join(folder, `${name}.scene`), out = join(folder, name);
  const save = (text) => writeFileSync(file, text);
  if (content) save(content);
  const words = ["watch", content ? file : args.shift(), "-o", out, "--preview", "--no-open", "-q", ...FEW, ...args];
  const child = started(words, { stdio: ["ignore", "ignore", "pipe"], cwd: folder });
  let said = "";
  const url = await new Promise((done, failed) => {
    child.stderr.on("data", (text) => {
      said += text;
      const url = /http:\/\/\S+/.exec(said)?.[0];
      if (url) done(url);
    });
    child.once("exit", (code) => failed(new Error(`luxel watch ended with ${code}: ${said}`)));
  });
  const token = new URL(url).searchParams.get("token");
  const end = () => new Promise((done) => {
    child.once("exit", done);
    child.kill("SIGINT");
  });
  return { url, token, port: new URL(url).port, file, out, save, end };
}

// The PNG of a scene as another run of the program renders it.
export function rendered(text, ...args) {
  const name = join(folder, `r${made++}`);
  writeFileSync(`${name}.scene`, text);
  execFileSync(luxel, ["render", `${name}.scene`, "-o", name, "-q", ...FEW, ...args], { stdio: "inherit" });
  return `${name}.png`;
}

export const worst = (a, b) => (a.length === b.length ? a.reduce((worst, v, i) => Math.max(worst, Math.abs(v - b[i])), 0) : Infinity);
// Whether the page shows that picture, but for the rounding of halves.
export async function shows(page, png) {
  const wanted = await decoded(page, png);
  let drawn;
  await until("the picture", async () => {
    drawn = await readback(page);
    return drawn && worst(drawn.data, wanted) <= 1;
  });
  return drawn.data;
}
// Whether one picture is left of the wipe and another one right of it; and waits for that.
export async function isWiped(page, left, right) {
  const drawn = await readback(page), [a, b] = [await decoded(page, left), await decoded(page, right)];
  const split = Math.round(0.5 * WINDOW.width) - drawn.x;
  assert.ok(split > 1 && split < SIZE[0] - 1, "the wipe is beside the picture");
  return drawn.data.every((v, i) => {
    const x = Math.floor(i / 4) % SIZE[0];
    return Math.abs(x - split) <= 1 || Math.abs(v - (x < split ? a : b)[i]) <= 1;
  });
}
export async function wiped(page, left, right) {
  await until("the wipe", async () => !(await isHidden(page, "wipe")));
  await until("both pictures", () => isWiped(page, left, right));
}
// Has a page take coarse pictures only, as of a scene that is slow and overtaken, while its `isCoarse` is set.
export const coarse = (page) => page.addInitScript(() => {
  window.isCoarse = false;
  Object.defineProperty(WebSocket.prototype, "onmessage", {
    set(heard) {
      this.addEventListener("message", (event) => {
        const { data } = event;
        if (window.isCoarse && typeof data !== "string") {
          const length = new DataView(data).getUint32(4, true);
          const { step } = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 8, length)));
          if (step === 1) return this.send(JSON.stringify("drawn"));
        }
        heard(event);
      });
    },
  });
});
// Has a browser stay busy with what is drawn in parts while its `isSlow` is set, and with nothing that is drawn as a whole.
export const slow = (page) => page.addInitScript(() => {
  Object.assign(window, { isSlow: false, isBusy: false });
  const { drawArrays, fenceSync, getSyncParameter } = WebGL2RenderingContext.prototype;
  const ofParts = new WeakSet();
  let isPart = false;
  Object.assign(WebGL2RenderingContext.prototype, {
    drawArrays(...what) {
      isPart = this.isEnabled(this.SCISSOR_TEST);
      drawArrays.apply(this, what);
    },
    fenceSync(...when) {
      const fence = fenceSync.apply(this, when);
      if (isPart) ofParts.add(fence);
      window.isBusy ||= isPart && window.isSlow;
      return fence;
    },
    getSyncParameter(fence, name) {
      return window.isSlow && ofParts.has(fence) ? this.UNSIGNALED : getSyncParameter.call(this, fence, name);
    },
  });
});
export const generation = (page) => page.evaluate(() => Number(document.getElementById("picture").dataset.generation));
export const done = (page) => until("the last sample", async () => /done/.test(await text(page, "status")));
export const facts = (page) => page.evaluate(() => Object.fromEntries([...document.querySelectorAll("#facts dt")].map((dt) => [dt.textContent, dt.nextElementSibling.textContent])));
export const slide = (page, name, value) => page.evaluate(({ name, value }) => {
  const input = document.querySelector(`#rows input[name=${name}]`);
  input.value = value;
  input.dispatchEvent(new Event("input", { bubbles: true }));
}, { name, value });
// As a shell reads it.
export const words = (line) => execFileSync("sh", ["-c", `printf '%s\\n' ${line}`]).toString().trim().split("\n");

// The corner of the canvas, and of the picture on it.
export async function corner(page) {
  const { x, y } = await page.locator("#picture").boundingBox(), area = await readback(page, false);
  return [x + area.x, y + area.y];
}

export async function begun(browser, content, options = { viewport: WINDOW }, ...args) {
  const one = await watch(content, ...args);
  const { page, complaints, close } = await open(browser, one.url, options);
  await done(page);
  await press(page, "z");
  const end = async () => {
    assert.deepEqual(complaints, []);
    await close();
    await one.end();
  };
  return { ...one, page, end };
}
