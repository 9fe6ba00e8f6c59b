// `luxel view` in a real browser. Not part of `cargo test`; in `.ci/run`, or:
//
//   tests/browser/test
//
// LUXEL is the program (default: target/debug/luxel of this tree), CHROMIUM the browser (default:
// `chromium`). Pictures of the page are left in SHOTS (default: tests/browser/shots). An argument
// chooses the tests whose names hold it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  PHONE, WINDOW, attacked, decoded, folder, isHidden, luxel, mean, open, press, readback, roomy, root, run, settled, shots, text, until, view,
} from "./common.mjs";

const SIZE = [96, 64];
function render(name, spp, seed) {
  const scene = join(root, "scenes/cornell.scene");
  const args = ["render", scene, "-o", join(folder, name), "--size", SIZE.join("x"), "--spp", spp, "--seed", seed, "-q"];
  execFileSync(luxel, args, { stdio: "inherit" });
  return join(folder, `${name}.exr`);
}

const LAYERS = `scene 1
camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (${SIZE.join(", ")}), normal = true, depth = true, material_id = true }
light constant { scale = 0.5 }
shape sphere { radius = 1 m, material = material diffuse { reflectance = 0.5 } }
`;

const tests = {
  async "a pixel of the page is the pixel of the PNG, in every tone"({ browser, one, folder }) {
    const { page, complaints, close } = await open(browser, one.url);
    await press(page, "z");
    const drawn = await readback(page), png = await decoded(page, join(folder, "a.png"));
    assert.deepEqual([drawn.w, drawn.h], SIZE);
    const worst = drawn.data.reduce((worst, v, i) => Math.max(worst, Math.abs(v - png[i])), 0);
    // Halves have 11 bits: an error of 2^-12 in a value, at most 0.5 of 255 after sRGB, and rounding.
    assert.ok(worst <= 1, `${worst} of 255 apart`);
    await press(page, "t");
    const linear = await readback(page);
    assert.ok(mean(linear.data) < mean(drawn.data) - 5, "linear is darker");
    await press(page, "t");
    assert.notDeepEqual((await readback(page)).data, linear.data);
    assert.deepEqual(complaints, []);
    await close();
  },

  async "a PNG of any display is what the page shows"({ browser, folder }) {
    for (const display of ["linear", "filmic"]) {
      const scene = join(folder, `${display}.scene`);
      writeFileSync(scene, LAYERS.replace("film rgb {", `film rgb { display = "${display}",`).replace("reflectance = 0.5", "reflectance = rgb.srgb(0.9, 0.5, 0.2)"));
      execFileSync(luxel, ["render", scene, "-o", join(folder, display), "--spp", 4, "-q"], { stdio: "inherit" });
      const own = await view(join(folder, `${display}.exr`));
      const { page, complaints, close } = await open(browser, own.url);
      await press(page, "z");
      assert.equal(await page.evaluate(() => document.getElementById("tone").value), display);
      const [drawn, png] = [await readback(page), await decoded(page, join(folder, `${display}.png`))];
      const worst = () => drawn.data.reduce((worst, v, i) => Math.max(worst, Math.abs(v - png[i])), 0);
      assert.ok(worst() <= 1, `${display}: ${worst()} of 255 apart`);
      assert.ok(Math.max(...png.filter((_, i) => i % 4 !== 3)) - Math.min(...png) > 40, "there is something to be seen");
      assert.deepEqual(complaints, []);
      await close();
      own.end();
    }
  },

  async "false colour is that of the pixel's luminance"({ browser, folder }) {
    const scene = join(folder, "false.scene");
    // Half the picture is as bright as white, the other half a sixteenth of that.
    const lamp = (x, scale) => `light area { shape = shape rectangle { u = (4, 0, 0) m, v = (0, 4, 0) m, transform = move((${x}, 0, 0) m) }, scale = ${scale} }\n`;
    writeFileSync(scene, LAYERS.replace(/light constant[^]*/, lamp(-2, 1) + lamp(2, 0.0625)));
    execFileSync(luxel, ["render", scene, "-o", join(folder, "false"), "--spp", 4, "-q"], { stdio: "inherit" });
    const own = await view(join(folder, "false.exr"));
    const { page, complaints, close } = await open(browser, own.url);
    await press(page, "z");
    await press(page, "2");
    const pixel = async (x) => {
      const { data, w, h } = await readback(page);
      return data.slice(4 * (w * (h >> 1) + x)).slice(0, 3);
    };
    // Twelve stops from 8 below white to 4 above it, over ten colours.
    const stops = "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725".split(" ").map((hex) => [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16)));
    const wanted = (stop) => {
      const t = ((stop + 8) / 12) * 9, k = Math.min(Math.floor(t), 8);
      return stops[k].map((v, c) => v + (stops[k + 1][c] - v) * (t - k));
    };
    const is = async (x, stop) => {
      const found = await pixel(x);
      // Of 256 steps of the scale: 9 / 255 of the way from one colour to the next.
      wanted(stop).forEach((v, c) => assert.ok(Math.abs(v - found[c]) <= 4, `${found} for ${wanted(stop)}`));
    };
    await is(20, 0);
    await is(76, -4);
    await press(page, "Shift+ArrowUp");
    await is(20, 1);
    await is(76, -3);
    assert.deepEqual(complaints, []);
    await close();
    own.end();
  },

  async "the keyboard's help opens and closes"({ browser, one }) {
    const { page, complaints, close } = await open(browser, one.url);
    const isOpen = () => page.evaluate(() => document.getElementById("help").open);
    assert.equal(await isOpen(), false);
    await press(page, "?");
    assert.equal(await isOpen(), true);
    // No other key does anything meanwhile.
    await press(page, "2");
    assert.equal(await isHidden(page, "legend"), true);
    await press(page, "Escape");
    assert.equal(await isOpen(), false);
    await press(page, "2");
    assert.equal(await isHidden(page, "legend"), false);
    await page.locator("#help-on").click();
    assert.equal(await isOpen(), true);
    await page.locator("#help button").click();
    assert.equal(await isOpen(), false);
    assert.deepEqual(complaints, []);
    await close();
  },

  async "layers can be chosen on a phone"({ browser, folder }) {
    const scene = join(folder, "phone.scene");
    writeFileSync(scene, LAYERS);
    execFileSync(luxel, ["render", scene, "-o", join(folder, "phone"), "--spp", 1, "-q"], { stdio: "inherit" });
    const own = await view(join(folder, "phone.exr"));
    const { page, complaints, close } = await open(browser, own.url, PHONE);
    assert.ok(await page.locator("#layer").isVisible());
    await roomy(page, "with layers");
    await page.locator("#layer").selectOption("normal");
    await until("the layer", async () => (await page.evaluate(() => document.getElementById("layer").value)) === "normal");
    await roomy(page, "with a layer");
    await page.screenshot({ path: join(shots, "layers-phone.png") });
    assert.deepEqual(complaints, []);
    await close();
    own.end();
  },

  async "exposure keys change the picture and 0 takes it back"({ browser, one }) {
    const { page, complaints, close } = await open(browser, one.url);
    const before = await readback(page);
    await press(page, "Shift+ArrowUp");
    assert.equal(await text(page, "stops"), "+1.0");
    assert.ok(mean((await readback(page)).data) > mean(before.data) + 5);
    await press(page, "0");
    assert.deepEqual((await readback(page)).data, before.data);
    await press(page, "a");
    assert.notEqual(await text(page, "stops"), "0.0");
    assert.deepEqual(complaints, []);
    await close();
  },

  async "false colour, error and histogram show themselves with a legend"({ browser, one }) {
    const { page, complaints, close } = await open(browser, one.url);
    await press(page, "2");
    assert.match(await text(page, "quantity"), /Luminance/);
    const luminance = await readback(page);
    await press(page, "3");
    assert.match(await text(page, "quantity"), /standard error/);
    assert.notDeepEqual((await readback(page)).data, luminance.data);
    await press(page, "h");
    assert.equal(await isHidden(page, "histogram"), false);
    await press(page, "1");
    assert.equal(await isHidden(page, "legend"), true);
    assert.deepEqual(complaints, []);
    await close();
  },

  async "a pixel tells the file's values, and the page's own agree"({ browser, one }) {
    const { page, complaints, close } = await open(browser, one.url);
    const area = await readback(page, false);
    const values = () => page.evaluate(() => [...document.querySelectorAll("#facts dd")].map((dd) => dd.textContent));
    // The page's own stand there for a moment only, less than it takes to ask for them on a busy machine.
    await page.evaluate(() => {
      window.first = null;
      new MutationObserver(() => {
        const now = [...document.querySelectorAll("#facts dd")].map((dd) => dd.textContent);
        if (now.length > 3) window.first ??= now;
      }).observe(document.getElementById("facts"), { childList: true, subtree: true, characterData: true });
    });
    await page.mouse.move(area.x + area.w * 0.3, area.y + area.h * 0.7);
    await until("own values", () => page.evaluate(() => window.first !== null));
    const own = await page.evaluate(() => window.first);
    await until("the file's values", async () => (await values())[0] !== own[0]);
    const exact = await values();
    for (const c of [0, 1, 2]) {
      const [a, b] = [own[c], exact[c]].map((v) => Number(v.replace("−", "-")));
      // Half a place of eleven bits, and half a place of the four digits that are shown.
      assert.ok(Math.abs(a - b) <= Math.abs(b) * (2 ** -11 + 5e-4), `${a} ${b}`);
    }
    assert.equal(exact.at(-1), "4");
    await page.mouse.click(area.x + area.w * 0.3, area.y + area.h * 0.7);
    await page.mouse.move(5, 5);
    assert.deepEqual(await values(), exact);
    await press(page, "Escape");
    assert.equal(await isHidden(page, "inspector"), true);
    assert.deepEqual(complaints, []);
    await close();
  },

  async "the layers of a file are shown, and a pixel tells their numbers"({ browser, folder }) {
    const scene = join(folder, "layers.scene");
    writeFileSync(scene, LAYERS);
    execFileSync(luxel, ["render", scene, "-o", join(folder, "layers"), "--spp", 2, "-q"], { stdio: "inherit" });
    const own = await view(join(folder, "layers.exr"));
    const { page, complaints, close } = await open(browser, own.url);
    const offered = await page.evaluate(() => [...document.getElementById("layer").options].map((it) => it.value));
    assert.deepEqual(offered, ["", "coverage", "depth", "material", "normal"]);
    await press(page, "z");
    const colour = await readback(page);
    const shown = async (choose, name) => {
      const before = await readback(page);
      await choose();
      await until(name, async () => String((await readback(page)).data) !== String(before.data));
      assert.equal(await page.evaluate(() => document.getElementById("layer").value), name);
      return readback(page);
    };
    const at = ({ data, w, h }) => [...data.slice(4 * (w * (h >> 1) + (w >> 1))).slice(0, 3)];
    const normal = at(await shown(() => page.locator("#layer").selectOption("normal"), "normal"));
    // Towards the camera: half of red and of green, all of blue.
    assert.ok(normal[2] === 255 && Math.abs(normal[0] - 188) <= 3 && Math.abs(normal[1] - 188) <= 3, normal);
    const area = await readback(page, false);
    await page.mouse.move(area.x + area.w / 2, area.y + area.h / 2);
    const facts = () => page.evaluate(() => Object.fromEntries([...document.querySelectorAll("#facts dt")].map((dt) => [dt.textContent, dt.nextSibling.textContent])));
    await until("what the file says", async () => (await facts()).material !== undefined);
    const told = await facts();
    assert.deepEqual([told.material, told.coverage, told.samples], ["1 (diffuse)", "1", "2"]);
    assert.ok(Math.abs(Number(told.depth) - 4) < 0.01 && Math.abs(Number(told.normal.split(" ")[2]) - 1) < 0.01, told.depth);
    await page.screenshot({ path: join(shots, "layer.png") });
    assert.deepEqual((await shown(() => press(page, "l"), "")).data, colour.data);
    assert.deepEqual(at(await shown(() => press(page, "l"), "coverage")), [255, 255, 255]);
    assert.deepEqual(complaints, []);
    await close();
    own.end();
  },

  async "the wipe shows the first picture on its left and the second on its right"({ browser, two, folder }) {
    const { page, complaints, close } = await open(browser, two.url);
    await until("the second picture", async () => !(await isHidden(page, "wipe")));
    await press(page, "z");
    await press(page, "ArrowLeft");
    const drawn = await readback(page);
    const [a, b] = [await decoded(page, join(folder, "a.png")), await decoded(page, join(folder, "b.png"))];
    const split = Math.round(0.48 * WINDOW.width) - drawn.x;
    for (let i = 0; i < drawn.data.length; i++) {
      const x = Math.floor(i / 4) % SIZE[0];
      if (Math.abs(x - split) <= 1) continue;
      assert.ok(Math.abs(drawn.data[i] - (x < split ? a : b)[i]) <= 1, `at ${x} of ${split}`);
    }
    await page.keyboard.down(" ");
    await settled(page);
    const other = await readback(page);
    assert.ok(other.data.every((v, i) => Math.abs(v - b[i]) <= 1));
    await page.keyboard.up(" ");
    await press(page, "4");
    assert.match(await text(page, "quantity"), /standard errors/);
    assert.deepEqual(complaints, []);
    await close();
  },

  async "a broken file lies over the last good picture until it is whole"({ browser, folder }) {
    const file = join(folder, "c.exr");
    copyFileSync(join(folder, "a.exr"), file);
    const own = await view(file);
    const { page, complaints, close } = await open(browser, own.url);
    const before = await readback(page);
    writeFileSync(file, "no picture");
    await until("the message", async () => !(await isHidden(page, "problems")));
    assert.match(await text(page, "problems"), /cannot read the picture .*c\.exr/);
    assert.deepEqual((await readback(page)).data, before.data);
    await page.screenshot({ path: join(shots, "problem.png") });
    copyFileSync(join(folder, "b.exr"), file);
    await until("no message", () => isHidden(page, "problems"));
    await until("the new picture", async () => mean((await readback(page)).data) !== mean(before.data));
    await page.locator("#compare").selectOption("previous");
    await until("the wipe", async () => !(await isHidden(page, "wipe")));
    own.end();
    await until("the end", async () => /does not answer|has ended/.test(await text(page, "status")));
    assert.deepEqual(complaints.filter((text) => !/WebSocket/.test(text)), []);
    await close();
  },

  "a foreign page that has stolen the token gets nothing": ({ browser, one }) => attacked(browser, one),

  async "it can be used on a phone and by light and dark"({ browser, two, one }) {
    const viewport = { width: 1280, height: 800 };
    const phone = { viewport: { width: 390, height: 760 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };
    const looks = { dark: { colorScheme: "dark", viewport }, light: { colorScheme: "light", viewport }, phone: { colorScheme: "dark", ...phone } };
    for (const [name, options] of Object.entries(looks)) {
      const { page, complaints, close } = await open(browser, process.env.SHOW ?? two.url, options);
      await until("the wipe", async () => !(await isHidden(page, "wipe")));
      const area = await readback(page, false);
      const ratio = options.deviceScaleFactor ?? 1;
      const at = [(area.x + area.w * 0.3) / ratio, (area.y + area.h * 0.6) / ratio];
      await (options.hasTouch ? page.touchscreen.tap(...at) : page.mouse.click(...at));
      await until("the inspector", async () => !(await isHidden(page, "inspector")));
      await press(page, "h");
      await page.waitForTimeout(300);
      await page.screenshot({ path: join(shots, `${name}.png`) });
      await press(page, "2");
      await page.screenshot({ path: join(shots, `${name}-luminance.png`) });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
      assert.equal(wide, false, `${name} is wider than its window`);
      await press(page, "?");
      await page.screenshot({ path: join(shots, `${name}-help.png`) });
      assert.deepEqual(complaints, []);
      await close();
    }
  },

  async "without WebGL 2 the same is drawn"({ browser, one, folder }) {
    const context = await browser.newContext({ viewport: WINDOW });
    await context.addInitScript(() => {
      const real = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind === "webgl2" ? null : real.call(this, kind, ...rest);
      };
    });
    const page = await context.newPage();
    await page.goto(one.url);
    await until("a picture", () => isHidden(page, "empty"));
    await press(page, "z");
    const drawn = await readback(page), png = await decoded(page, join(folder, "a.png"));
    assert.deepEqual([drawn.w, drawn.h], SIZE);
    assert.ok(drawn.data.every((v, i) => Math.abs(v - png[i]) <= 1));
    await context.close();
  },
};

const [a, b] = [render("a", 4, 1), render("b", 8, 2)];
const [one, two] = [await view(a), await view(a, b)];
await run(tests, { one, two });
