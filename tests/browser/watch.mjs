// `luxel watch --preview` in a real browser: as `view.mjs`.

import assert from "node:assert/strict";
import { basename, join } from "node:path";
import { PHONE, attacked, isHidden, mean, open, press, readback, roomy, root, run, shots, text, until, view } from "./common.mjs";
import { begun, CAMERA, coarse, corner, done, facts, generation, isWiped, rendered, scene, shows, SIZE, slide, slow, watch, WINDOW, wiped, words, worst } from "./watching.mjs";

const tests = {
  async "after twelve saves 60 ms apart the last is shown"({ browser }) {
    const { page, save, end } = await begun(browser, scene());
    for (let i = 1; i <= 12; i++) {
      save(scene({ grey: String(i / 16), radius: `${1 + i / 20} m` }));
      await page.waitForTimeout(60);
    }
    await shows(page, rendered(scene({ grey: String(12 / 16), radius: `${1 + 12 / 20} m` })));
    await done(page);
    await end();
  },

  async "a mistake lies over the last good picture until it is mended"({ browser }) {
    const { page, save, end } = await begun(browser, scene());
    const before = (await readback(page)).data;
    save(scene().replace("radius", "radus"));
    await until("the message", async () => !(await isHidden(page, "problems")));
    assert.match(await text(page, "problems"), /radus[^]*\.scene:7:/);
    assert.deepEqual((await readback(page)).data, before);
    save(scene({ grey: "0.2" }));
    await until("no message", () => isHidden(page, "problems"));
    await shows(page, rendered(scene({ grey: "0.2" })));
    await end();
  },

  async "a pixel tells what it shows, where that is written, and opens it"({ browser }) {
    const editor = ["--editor", "vscode://file/{file}:{line}:{column}"];
    const { page, file, end } = await begun(browser, scene(), { viewport: WINDOW }, ...editor);
    const [x, y] = await corner(page);
    await page.mouse.click(x + SIZE[0] / 2 + 0.5, y + SIZE[1] / 2 + 0.5);
    await until("the facts", async () => (await facts(page)).shape);
    const found = await facts(page);
    assert.equal(found.shape, 'sphere "ball"');
    assert.equal(found["written at"], `${basename(file)}:7:1`);
    assert.match(found.material, /^diffuse, \w+\.scene:6:/);
    assert.match(found.depth, /^4\.0\d+ m$/);
    // White light on a grey ball that sees nothing else: half of it comes back.
    assert.ok(Math.abs(Number(found.luminance) - 0.4) < 0.02, found.luminance);
    const [href] = await page.evaluate(() => [...document.querySelectorAll("#facts a")].map((a) => a.href));
    assert.equal(href, `vscode://file/${file.slice(1)}:7:1`);
    await end();
    const bare = await begun(browser, scene());
    await bare.page.mouse.click(x + SIZE[0] / 2 + 0.5, y + SIZE[1] / 2 + 0.5);
    await until("a button", () => bare.page.evaluate(() => document.querySelectorAll("#facts dd button").length === 2));
    assert.equal(await bare.page.evaluate(() => document.querySelectorAll("#facts a").length), 0);
    await bare.end();
  },

  async "a pixel tells what is written to the file, to the last bit"({ browser }) {
    const { page, out, end } = await begun(browser, scene());
    const own = await view(`${out}.exr`);
    const file = await open(browser, own.url, { viewport: WINDOW });
    await press(file.page, "z");
    const values = async (of, at) => {
      const [x, y] = await corner(of);
      await of.mouse.move(x + at[0] + 0.5, y + at[1] + 0.5);
      // The page's own, which stand there first, have four digits.
      const isTold = async () => (await text(of, "where")) === at.join(", ") && !/^0\.0*[1-9]\d{3}$/.test((await facts(of)).R);
      await until("exact values", isTold);
      const { R, G, B, luminance, relative, samples, "standard error": error } = await facts(of);
      return { R, G, B, luminance, relative, samples, error };
    };
    let differ = 0;
    for (const at of [[24, 16], [17, 12], [14, 16], [30, 9], [2, 3]]) {
      const [here, there] = [await values(page, at), await values(file.page, at)];
      assert.deepEqual(here, there, `at ${at}`);
      assert.equal(here.samples, "4");
      assert.ok(Math.abs(0.2126 * here.R + 0.7152 * here.G + 0.0722 * here.B - here.luminance) < 1e-3 * here.luminance, "its own luminance");
      differ += here.error.split(" ").some((v) => Number(v) > 0);
    }
    assert.ok(differ > 0, "some pixel has an error");
    await file.close();
    own.end();
    await end();
  },

  async "the wipe shows this picture and the previous one"({ browser }) {
    const { page, save, end } = await begun(browser, scene());
    save(scene({ grey: "0.1" }));
    const [now, past] = [rendered(scene({ grey: "0.1" })), rendered(scene())];
    await shows(page, now);
    await done(page);
    await page.locator("#compare").selectOption("previous");
    await wiped(page, now, past);
    await end();
  },

  async "a picture that never became whole is not the previous one"({ browser }) {
    const one = await watch(scene());
    const { page, complaints, close } = await open(browser, one.url, { viewport: WINDOW, before: coarse });
    await done(page);
    await press(page, "z");
    const first = await generation(page);
    // A coarse picture is missed now and then when the next one is there before it is sent.
    await page.evaluate(() => (window.isCoarse = true));
    for (let i = 0; (await generation(page)) === first; i++) {
      assert.ok(i < 40, "no coarse picture came");
      one.save(scene({ grey: `0.${20 + i}` }));
      await page.waitForTimeout(250);
    }
    assert.ok((await generation(page)) > first);
    await page.evaluate(() => (window.isCoarse = false));
    one.save(scene({ grey: "0.1" }));
    const [now, past] = [rendered(scene({ grey: "0.1" })), rendered(scene())];
    await shows(page, now);
    await done(page);
    await page.locator("#compare").selectOption("previous");
    await wiped(page, now, past);
    assert.deepEqual(complaints, []);
    await close();
    await one.end();
  },

  async "the first picture of an edit waits for no better one of the edit before"({ browser }) {
    const { page, save, end } = await begun(browser, scene(), { viewport: WINDOW, before: slow });
    await page.evaluate(() => (window.isSlow = true));
    // A better picture is missed now and then when the last one is there before the first is sent.
    for (let i = 0; !(await page.evaluate(() => window.isBusy)); i++) {
      assert.ok(i < 40, "no better picture came");
      save(scene({ grey: `0.${20 + i}` }));
      await page.waitForTimeout(250);
    }
    const before = await generation(page);
    save(scene({ grey: "0.1" }));
    await until("the next edit", async () => (await generation(page)) > before);
    await page.evaluate(() => (window.isSlow = false));
    await shows(page, rendered(scene({ grey: "0.1" })));
    await done(page);
    await end();
  },

  async "a picture that was pinned stays to be compared with"({ browser }) {
    const { page, save, end } = await begun(browser, scene());
    const pinned = () => page.evaluate(() => [document.getElementById("compare").value, document.getElementById("pin").getAttribute("aria-pressed")]);
    assert.deepEqual(await pinned(), ["off", "false"]);
    await press(page, "p");
    assert.deepEqual(await pinned(), ["pinned", "true"]);
    const [first, second, third] = [scene(), scene({ grey: "0.1" }), scene({ grey: "0.9" })].map((it) => rendered(it));
    await wiped(page, first, first);
    for (const [grey, png] of [["0.1", second], ["0.9", third]]) {
      save(scene({ grey }));
      await until(`grey ${grey}`, () => isWiped(page, png, first));
    }
    assert.equal(await text(page, "right"), "pinned");
    await done(page);
    await page.locator("#pin").click();
    await wiped(page, third, third);
    save(scene({ grey: "0.1" }));
    await until("the pinned picture", () => isWiped(page, second, third));
    await press(page, "c");
    await shows(page, second);
    await end();
  },

  async "a slider renders another picture and says how a command line does"({ browser }) {
    const params = "/// How large.\nparam r: length = 90 cm in 30 cm..=2 m\nparam dark: bool = false\nparam far: angle = 40 deg in 20 deg..60 deg";
    const camera = CAMERA.replace("40 deg", "far");
    const content = scene({ params, camera, radius: "r", grey: 'if dark { 0.1 } else { 0.5 }' });
    const { page, save, end } = await begun(browser, content);
    const before = (await readback(page)).data;
    assert.equal(await isHidden(page, "set-line"), true);
    // As fast as a hand moves it; the last counts.
    for (let cm = 60; cm <= 150; cm += 5) await slide(page, "r", cm);
    await until("the line", async () => (await text(page, "set-text")) === "--set 'r=150 cm'");
    await shows(page, rendered(content, "--set", "r=150 cm"));
    // Beyond what the range takes there is nothing on the slider, and its open end is not reached.
    await slide(page, "far", 60);
    await page.locator("#rows input[name=dark]").check();
    await until("the line", async () => /dark=true/.test(await text(page, "set-text")));
    const line = await text(page, "set-text");
    assert.match(line, /^--set 'r=150 cm' --set 'far=59\.9 deg' --set dark=true$/);
    await shows(page, rendered(content, ...words(line)));
    assert.equal(await isHidden(page, "problems"), true);
    // A param that the file has no more is forgotten without a word.
    const without = scene({ params: params.replace("param dark", "let dark"), camera, radius: "r", grey: 'if dark { 0.1 } else { 0.5 }' }).replace("let dark: bool", "let dark");
    save(without);
    await until("the line", async () => (await text(page, "set-text")) === "--set 'r=150 cm' --set 'far=59.9 deg'");
    await shows(page, rendered(without, ...words(await text(page, "set-text"))));
    assert.equal(await isHidden(page, "problems"), true);
    await page.locator("#params-reset").click();
    await until("no line", () => isHidden(page, "set-line"));
    save(content);
    await until("the file's picture", async () => worst((await readback(page)).data, before) === 0);
    await done(page);
    await end();
  },

  async "colours and rows of numbers have fields that say what a command line says"({ browser }) {
    const params = "param tint: color = rgb.srgb(0.5, 0.25, 1)\nparam at: vec3 = (0, 0, -20) cm\nparam sizes: length[] = [90 cm, 1 m]\nparam lamp: color = illuminant(\"D65\")";
    const content = scene({ params, grey: "tint", radius: "sizes[0]" }).replace(", material = grey }", ", center = at, material = grey }");
    const { page, end } = await begun(browser, content);
    const before = (await readback(page)).data;
    const input = (name) => page.locator(`#rows input[name=${name}]`);
    const values = (...names) => Promise.all(names.map((name) => input(name).inputValue()));
    const type = async (name, value) => {
      await input(name).fill(value);
      await input(name).press("Enter");
      await input(name).blur();
    };
    const line = (wanted) => until(`the line ${wanted}`, async () => (await text(page, "set-text")) === wanted);
    const names = await page.evaluate(() => [...document.querySelectorAll("#rows .row > span:first-child")].map((name) => name.textContent));
    assert.deepEqual(names, ["tint", "at", "sizes"]);
    assert.deepEqual(await values("tint-colour", "at-0", "at-2", "sizes-0", "sizes-1"), ["#8040ff", "0", "-20", "90", "100"]);
    assert.deepEqual(await values("tint-0", "tint-1", "tint-2"), ["0.214", "0.05088", "1"]);
    // Whatever is picked is sRGB, and stands beside it as linear numbers.
    await page.evaluate(() => {
      const picker = document.querySelector("#rows input[name=tint-colour]");
      picker.value = "#ff8000";
      picker.dispatchEvent(new Event("input", { bubbles: true }));
    });
    await line("--set 'tint=rgb.srgb(1, 0.502, 0)'");
    await shows(page, rendered(content, ...words(await text(page, "set-text"))));
    await until("the numbers", async () => (await values("tint-0", "tint-1", "tint-2")).join() === "1,0.2159,0");
    // One number of three: the others stay as they are to the last bit, not as they are shown.
    await type("tint-2", "0.25");
    await until("the line", async () => /^--set 'tint=rgb\.linear_srgb\(1, 0\.21\d{8,}, 0\.25\)'$/.test(await text(page, "set-text")));
    const tint = await text(page, "set-text");
    await until("the colour", async () => (await values("tint-colour"))[0] === "#ff8089");
    await type("at-1", "-12.5");
    await line(`${tint} --set 'at=(0, -12.5, -20) cm'`);
    // A number may bring its own unit.
    await type("sizes-0", "700 mm");
    await line(`${tint} --set 'at=(0, -12.5, -20) cm' --set 'sizes=[700 mm, 100 cm]'`);
    await until("the number", async () => (await values("sizes-0"))[0] === "70");
    await shows(page, rendered(content, ...words(await text(page, "set-text"))));
    assert.equal(await isHidden(page, "problems"), true);
    await page.locator("#params-reset").click();
    await until("the file's picture", async () => worst((await readback(page)).data, before) === 0);
    await until("the file's values", async () => (await values("tint-colour", "sizes-0", "at-1")).join() === "#8040ff,90,0");
    await done(page);
    await end();
  },

  async "a value that the scene refuses is told as any mistake"({ browser }) {
    const content = scene({ params: "param n: int = 1 in 1..=9\nassert n < 5, \"too many\"", radius: "n * 1 m / 2" });
    const { page, end } = await begun(browser, content);
    await slide(page, "n", 7);
    await until("the message", async () => !(await isHidden(page, "problems")));
    assert.match(await text(page, "problems"), /too many/);
    await slide(page, "n", 2);
    await until("no message", () => isHidden(page, "problems"));
    await shows(page, rendered(content, "--set", "n=2"));
    await end();
  },

  async "a camera without perspective shows less where another comes closer"({ browser }) {
    const camera = CAMERA.replace("perspective", "orthographic").replace("fov = 40 deg", "height = 4 m");
    const { page, end } = await begun(browser, scene({ camera }));
    const before = (await readback(page)).data;
    await press(page, "o");
    await page.mouse.move(600, 120);
    await page.mouse.wheel(0, -240);
    const height = async () => Number((await text(page, "camera-text")).match(/height = ([\d.]+) m/)?.[1]);
    await until("less to be seen", async () => (await height()) < 4);
    await page.waitForTimeout(300);
    await done(page);
    await shows(page, rendered(scene({ camera: await text(page, "camera-text") })));
    assert.ok(worst((await readback(page)).data, before) > 20, "another picture");
    await press(page, "Escape");
    await until("the file's camera", async () => worst((await readback(page)).data, before) === 0);
    await end();
  },

  async "the camera is turned, moved and brought closer, pasted, and goes back bit for bit"({ browser }) {
    const { page, save, end } = await begun(browser, scene({ camera: CAMERA.replace("}", ", shift = (0.1, 0) }") }));
    const before = (await readback(page)).data;
    await press(page, "o");
    const middle = [600, 120];
    const drag = async (...by) => {
      await page.mouse.move(...middle);
      await page.mouse.down();
      await page.mouse.move(middle[0] + by[0] / 2, middle[1] + by[1] / 2, { steps: 4 });
      await page.mouse.move(middle[0] + by[0], middle[1] + by[1], { steps: 4 });
      await page.mouse.up();
    };
    const view = async () => (await text(page, "camera-text")).match(/look_at\(.*\)/)[0];
    const moves = {
      turned: () => drag(120, 40),
      moved: async () => {
        await page.keyboard.down("Shift");
        await drag(6, -4);
        await page.keyboard.up("Shift");
      },
      closer: async () => {
        await page.mouse.move(...middle);
        await page.mouse.wheel(0, -120);
      },
    };
    let last = await view();
    for (const [how, move] of Object.entries(moves)) {
      await move();
      await until(`the camera ${how}`, async () => (await view()) !== last);
      last = await view();
    }
    // The last of what was sent has come back.
    await page.waitForTimeout(300);
    await done(page);
    const block = await text(page, "camera-text");
    assert.match(block, /fov = 40 deg\n {2}shift = \(0\.1, 0\)/);
    await shows(page, rendered(scene({ camera: block })));
    assert.ok(worst((await readback(page)).data, before) > 20, "another picture");
    await press(page, "Escape");
    await until("the file's camera", async () => worst((await readback(page)).data, before) === 0);
    // A save of another camera takes the page's away, one of anything else does not.
    await drag(60, 0);
    await until("the camera", async () => !/\(0, 0, 5\)/.test(await view()));
    await page.waitForTimeout(300);
    await done(page);
    const kept = await text(page, "camera-text");
    save(scene({ camera: CAMERA.replace("}", ", shift = (0.1, 0) }"), grey: "0.3" }));
    await shows(page, rendered(scene({ camera: kept, grey: "0.3" })));
    const other = CAMERA.replace("(0, 0, 5)", "(1, 0, 4)");
    save(scene({ camera: other }));
    await shows(page, rendered(scene({ camera: other })));
    await end();
  },

  "a foreign page that has stolen the token gets nothing": async ({ browser }) => {
    const one = await watch(scene());
    await attacked(browser, one);
    await one.end();
  },

  async "it can be used on a phone with fingers"({ browser }) {
    const params = "/// How large.\nparam radius_of_the_ball: length = 90 cm in 30 cm..=2 m\nparam dark: bool = false\nparam of: string = \"oak\"\nparam tint: color = rgb.srgb(1, 0, 0)\nparam at: vec3 = (1, 2, 3) cm";
    const content = scene({ params, radius: "radius_of_the_ball" });
    const { page, end } = await begun(browser, content, PHONE, "--editor", "zed://file/{file}:{line}");
    await press(page, "f");
    await roomy(page, "at first");
    const { x, y, width, height } = await page.locator("#picture").boundingBox();
    await page.touchscreen.tap(x + width / 2, y + height / 2);
    await until("the facts", async () => (await facts(page)).shape);
    assert.equal(await page.evaluate(() => document.querySelectorAll("#facts a").length), 2);
    await roomy(page, "with a pixel");
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(shots, "watch-phone-pixel.png") });
    await press(page, "Escape");
    const tap = (id) => page.locator(`#${id}`).tap();
    await tap("camera-on");
    await done(page);
    const before = (await readback(page)).data;
    await tap("camera-on");
    await tap("params-on");
    await until("the params", () => page.locator("#rows").isVisible());
    await slide(page, "radius_of_the_ball", 120);
    await until("the line", async () => !(await isHidden(page, "set-line")));
    await roomy(page, "with params");
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(shots, "watch-phone-params.png") });
    await tap("params-reset");
    await tap("params-on");
    await tap("camera-on");
    await until("no line", () => isHidden(page, "set-line"));
    await until("the file's picture", async () => worst((await readback(page)).data, before) === 0);
    const session = await page.context().newCDPSession(page);
    const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await touch("touchStart", [150, 200]);
    for (let x = 155; x <= 220; x += 13) await touch("touchMove", [x, 200 + (x - 155) / 2]);
    await touch("touchEnd");
    await until("another picture", async () => worst((await readback(page)).data, before) > 20);
    await roomy(page, "with the camera");
    const turned = await text(page, "camera-text");
    await touch("touchStart", [150, 200], [230, 200]);
    for (let x = 150; x >= 100; x -= 10) await touch("touchMove", [x, 200], [380 - x, 200]);
    await touch("touchEnd");
    await until("closer", async () => (await text(page, "camera-text")) !== turned);
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(shots, "watch-phone-camera.png") });
    await tap("camera-reset");
    await until("the file's picture", async () => worst((await readback(page)).data, before) === 0);
    await end();
  },

  async "it can be used by light and dark"({ browser }) {
    for (const colorScheme of ["dark", "light"]) {
      const stair = join(root, "scenes/parametric.scene");
      const one = await watch(null, stair, "--size", "240x320", "--editor", "vscode://file/{file}:{line}:{column}");
      const { page, complaints, close } = await open(browser, one.url, { colorScheme, viewport: { width: 1280, height: 800 } });
      await slide(page, "radius", 130);
      await until("the line", async () => !(await isHidden(page, "set-line")));
      await press(page, "o");
      await press(page, "h");
      await page.mouse.move(800, 300);
      await page.mouse.down();
      await page.mouse.move(860, 310, { steps: 6 });
      await page.mouse.up();
      await done(page);
      const { x, width } = await page.locator("#picture").boundingBox();
      await page.mouse.click(x + width / 2, 460);
      await until("the inspector", async () => (await facts(page)).shape);
      await page.waitForTimeout(500);
      await done(page);
      await page.screenshot({ path: join(shots, `watch-${colorScheme}.png`) });
      const [back, front] = await page.evaluate(() => {
        const of = (text) => text.match(/[\d.]+/g).slice(0, 3).map(Number);
        const style = getComputedStyle(document.body);
        return [of(style.backgroundColor), of(style.color)];
      });
      assert.ok(colorScheme === "dark" ? mean(back) < 60 && mean(front) > 180 : mean(back) > 180 && mean(front) < 60);
      assert.deepEqual(complaints, []);
      await close();
      await one.end();
    }
  },
};

await run(tests, {});
