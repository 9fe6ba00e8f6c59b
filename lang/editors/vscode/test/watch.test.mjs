// The preview's watch against a program that behaves as `luxel watch` does.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, test } from "node:test";
import { buildSync } from "esbuild";

const here = resolve(import.meta.dirname, "..");
const bundle = join(here, "build/watch.mjs");
buildSync({ entryPoints: [join(here, "src/watch.ts")], outfile: bundle, bundle: true, platform: "node", format: "esm" });
const { Watch } = await import(bundle);

const folder = mkdtempSync(join(tmpdir(), "luxel-watch-"));
after(() => rmSync(folder, { recursive: true }));

const scene = join(folder, "a.scene");
const program = join(here, "test/fake-luxel.mjs");

// What a watch told until `enough`, after which it is stopped, and how it ended.
function watched(given, enough) {
  return new Promise((done) => {
    const told = [];
    const tell = (what) => (value) => {
      told.push([what, value]);
      if (what === "ended") done(told);
      else if (enough(told)) watch.stop();
    };
    const listener = { address: tell("address"), picture: tell("picture"), message: tell("message"), ended: tell("ended") };
    const watch = new Watch({ program, scene, folder, editor: "vscode://file/{file}:{line}:{column}", more: [], ...given }, listener);
  });
}

const of = (told, what) => told.filter(([name]) => name === what).map(([, value]) => value);

test("address, pictures and mistakes are told, and stopping ends it well", async () => {
  const told = await watched({ more: ["--spp", "4"] }, (told) => of(told, "picture").length && of(told, "message").length > 1);
  assert.deepEqual(of(told, "address"), ["http://127.0.0.1:4711/?token=abc"]);
  assert.deepEqual(of(told, "picture"), [join(folder, "a.png")]);
  const messages = of(told, "message");
  assert.ok(messages.includes("a.scene:2:7: unknown kind"));
  assert.ok(messages.includes("a.scene: no camera"), "of no place none is told");
  assert.ok(messages.includes("a full disk"), "and of no scene no file");
  assert.ok(messages.includes(""), "a finished picture takes the last message away");
  assert.ok(!of(told, "message").includes("not told"));
  assert.deepEqual(of(told, "ended"), [0]);
  const { given, cwd } = JSON.parse(readFileSync(join(folder, "a.started"), "utf8"));
  assert.deepEqual(given, ["watch", scene, "--preview", "--no-open", "--json", "--editor",
    "vscode://file/{file}:{line}:{column}", "-o", join(folder, "a"), "--spp", "4"]);
  assert.equal(cwd, folder);
});

test("a picture of the first sample is told before its summary", async () => {
  process.env.FAKE = "slow";
  const told = await watched({}, (told) => of(told, "picture").length);
  delete process.env.FAKE;
  assert.equal(of(told, "picture")[0], join(folder, "a.png"));
});

test("a program that refuses is told with what it says and its code", async () => {
  process.env.FAKE = "refuses";
  const told = await watched({}, () => false);
  delete process.env.FAKE;
  assert.deepEqual(told, [["message", "error: no such scene"], ["ended", 1]]);
});

test("a program that is not there is told once", async () => {
  const told = await watched({ program: join(folder, "nothing") }, () => false);
  assert.equal(told.length, 1);
  assert.equal(told[0][1].code, "ENOENT");
});

test("a folder that is not there is told, and the watch goes on", async () => {
  const gone = join(folder, "gone");
  const told = await watched({ folder: gone, program: process.execPath, more: [] }, () => false);
  assert.match(of(told, "message")[0], /^the first picture cannot be waited for: .*ENOENT/);
  assert.equal(told.at(-1)[0], "ended");
});

test("a program that does not listen is ended in any case", async () => {
  process.env.FAKE = "stubborn";
  const told = await watched({}, (told) => of(told, "picture").length);
  delete process.env.FAKE;
  assert.deepEqual(of(told, "ended"), [null]);
});
