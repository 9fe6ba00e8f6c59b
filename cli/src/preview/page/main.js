// The page: what is shown, and what follows when something changes.

import { bar } from "./bar.js";
import { Camera } from "./camera.js";
import { copy } from "./copy.js";
import { flat } from "./flat.js";
import { withGl } from "./gl.js";
import { keys } from "./keys.js";
import { Pan } from "./pan.js";
import { $, histogram, inspect, legend, problems } from "./panels.js";
import { params } from "./params.js";
import { luminance } from "./picture.js";
import { connect } from "./wire.js";

const canvas = $("picture");
const painter = withGl(canvas) ?? flat(canvas);

const state = {
  a: null, b: null, previous: null, pinned: null,
  layers: [], layer: null,
  view: "colour", tone: "srgb", ev: 0, compare: "off", wipe: 0.5, flipped: false, bins: false,
  hovered: null, held: null, reply: null,
  get other() { return this.compare === "off" ? null : this[this.compare]; },
  get otherName() { return this.compare === "b" ? this.b?.name || "B" : this.compare; },
  get shownPicture() { return this.flipped && this.other ? this.other : this.a; },
  // Both of two pictures are exposed as the first.
  scaleOf() { return this.a.scale * 2 ** this.ev; },
};

const pan = new Pan(canvas, {
  changed: () => redraw(),
  tapped: (at) => hold(at),
  hovered: (at) => hover(at),
  wheeled: (notches) => act.exposureBy(notches / 3),
  camera: () => camera,
});
const camera = new Camera((command) => wire.ask(command), pan);

// Drawing: once for all that changed between two pictures of the screen.
let due = false;
let afterDrawing = [];
function redraw() {
  giveUp();
  if (due) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    paint();
    const waiting = afterDrawing.splice(0);
    if (waiting.length) painter.finished(() => waiting.forEach((drawn) => drawn()));
  });
}

// A better picture of the edit on the screen is drawn in parts, so that the next edit's first need not wait.
let giveUp = () => {};
function refine(drawn) {
  giveUp();
  const end = () => {
    giveUp = () => {};
    drawn();
  };
  const shown = () => {
    tell();
    end();
  };
  const stop = attempt(() => painter.drawInParts(state, pan, devicePixelRatio, shown));
  if (!stop) return end();
  giveUp = () => {
    stop();
    end();
  };
}

function attempt(draw) {
  try {
    return draw();
  } catch (error) {
    $("empty").hidden = false;
    $("empty").textContent = error.message;
  }
}

function paint() {
  const ratio = devicePixelRatio, [w, h] = pan.room.map((side) => Math.max(Math.round(side * ratio), 1));
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  $("empty").hidden = Boolean(state.a);
  if (!state.a) return;
  attempt(() => painter.draw(state, pan, ratio));
  tell();
}

// What stands around the picture on the screen.
function tell() {
  // Which edit is on the screen, for whoever measures how soon.
  canvas.dataset.generation = state.a.generation;
  legend(state);
  $("histogram").hidden = !state.bins;
  if (state.bins) histogram(state);
  placeWipe();
  placeMark();
  tellPixel();
  controls.update();
}

function placeWipe() {
  const wiped = Boolean(state.other) && !state.flipped && state.view !== "difference";
  const x = state.wipe * pan.room[0], top = Math.max(pan.y, 0);
  for (const id of ["wipe", "left", "right"]) {
    $(id).hidden = !wiped;
    $(id).style.left = `${x}px`;
    $(id).style.top = `${id === "wipe" ? top : top + 10}px`;
  }
  $("wipe").style.height = `${Math.max(Math.min(pan.y + pan.size[1] * pan.zoom, pan.room[1]) - top, 0)}px`;
  $("wipe").setAttribute("aria-valuenow", Math.round(state.wipe * 100));
  $("left").textContent = state.compare === "b" ? state.a.name || "A" : "now";
  $("right").textContent = state.otherName;
}

function placeMark() {
  const mark = $("mark");
  mark.hidden = !state.held;
  if (!state.held) return;
  const side = Math.max(pan.zoom, 5), shift = (pan.zoom - side) / 2;
  mark.style.left = `${pan.x + state.held[0] * pan.zoom + shift}px`;
  mark.style.top = `${pan.y + state.held[1] * pan.zoom + shift}px`;
  mark.style.width = mark.style.height = `${side}px`;
}

// The pixel in hand, and the question for what the program knows of it.
let asking = 0;
function sideOf(at) {
  const right = pan.x + (at[0] + 0.5) * pan.zoom > state.wipe * pan.room[0];
  const shown = state.flipped || (right && state.view !== "difference");
  return state.other && shown ? "b" : "a";
}
function tellPixel() {
  const at = state.held ?? state.hovered;
  const side = at ? sideOf(at) : "a";
  const reply = state.reply?.key === `${at} ${side}` ? state.reply : null;
  inspect(state, at, side, reply, Boolean(state.held));
}
function ask() {
  clearTimeout(asking);
  asking = setTimeout(() => {
    const at = state.held ?? state.hovered;
    if (!at) return;
    const side = sideOf(at);
    // Of pictures of the past the program knows nothing.
    if (side === "a" || state.compare === "b") wire.ask({ pixel: { at, side } });
  }, 40);
}
// What was told of the picture before is not true of the next; what is seen in the pixel mostly is.
function outdate() {
  const ofPicture = ["radiance", "standard error", "samples"];
  if (state.reply) state.reply.facts = state.reply.facts.filter(([name]) => !ofPicture.includes(name));
}
function hover(at) {
  if (String(at) === String(state.hovered)) return;
  state.hovered = at;
  placeInspector(at);
  ask();
  redraw();
}
// Not over the pixel that it tells of; where it is as wide as the window, above it or below.
function placeInspector(at) {
  if (!at) return;
  const [x, y] = [pan.x + at[0] * pan.zoom, pan.y + at[1] * pan.zoom];
  $("inspector").classList.toggle("aside", x > pan.room[0] - 400 && y < 260);
  $("inspector").classList.toggle("low", y < pan.room[1] / 2);
}
function hold(at) {
  placeInspector(at);
  state.held = at && String(at) !== String(state.held) ? at : null;
  state.hovered = at;
  ask();
  redraw();
}

const act = {
  view(view) { state.view = view === "difference" && !state.other ? state.view : view; redraw(); },
  exposure(ev) { state.ev = Math.min(Math.max(ev, -30), 30); redraw(); },
  exposureBy(stops) { act.exposure(Math.round((state.ev + stops) * 60) / 60); },
  // The 98th part of a hundred comes to white.
  autoExposure() {
    const all = state.a && [...state.a.spread(100000)].map((rgb) => luminance(...rgb)).filter((v) => v > 0 && v < Infinity);
    if (!all?.length) return;
    const bright = all.sort((x, y) => x - y)[Math.floor(all.length * 0.98)];
    act.exposure(Math.round(-Math.log2(bright * state.a.scale) * 20) / 20);
  },
  layer(name) { wire.ask({ layer: { name } }); },
  nextLayer() {
    const all = [null, ...state.layers];
    if (state.layers.length) act.layer(all[(all.indexOf(state.layer) + 1) % all.length]);
  },
  tone(tone) { state.tone = tone; redraw(); },
  nextTone() { act.tone({ srgb: "linear", linear: "filmic", filmic: "srgb" }[state.tone]); },
  compare(what) {
    state.compare = what === "off" || state[what] ? what : "off";
    if (!state.other && state.view === "difference") state.view = "colour";
    redraw();
  },
  nextCompare() {
    const ways = ["off", "b", "previous", "pinned"].filter((way) => way === "off" || state[way]);
    act.compare(ways[(ways.indexOf(state.compare) + 1) % ways.length]);
  },
  pin() { state.pinned = state.a; act.compare("pinned"); },
  wipe(t) { state.wipe = Math.min(Math.max(t, 0), 1); redraw(); },
  wipeBy(t) { if (state.other) act.wipe(state.wipe + t); },
  flip(flipped) { if (state.flipped !== flipped) { state.flipped = flipped; redraw(); } },
  fit() { pan.fit(); },
  oneToOne() { pan.oneToOne(); },
  zoom(factor) { pan.zoomBy(factor); },
  histogram() { state.bins = !state.bins; redraw(); },
  help() { $("help").showModal(); },
  // What was done last is let go first: a pixel, then the camera.
  release() {
    if (!state.held) camera.reset();
    state.held = null;
    state.reply = null;
    redraw();
  },
  camera() { camera.toggle(); },
  params(shown = $("side").classList.contains("closed")) {
    $("side").classList.toggle("closed", !shown);
    $("params-on").setAttribute("aria-pressed", shown);
  },
};

const controls = bar(state, pan, act);
keys(act);
// A small window shows the picture first.
act.params(matchMedia("(min-width: 561px)").matches);
$("camera-on").addEventListener("click", act.camera);
$("params-on").addEventListener("click", () => act.params());
$("camera-reset").addEventListener("click", () => camera.reset());
$("params-reset").addEventListener("click", () => wire.ask("reset_params"));
$("camera-copy").addEventListener("click", () => copy($("camera-text").textContent, $("camera-copy")));
$("set-copy").addEventListener("click", () => copy($("set-text").textContent, $("set-copy")));

const wire = connect({
  picture(picture, drawn) {
    const first = !state.a;
    const isBetter = picture.side !== "b" && state.a?.generation === picture.generation && !due && !document.hidden;
    if (picture.side === "b") {
      state.b = picture;
      if (state.compare === "off") state.compare = "b";
    } else {
      // A picture that was overtaken while it was coarse is none to compare with.
      if (state.a?.step === 1 && state.a.generation !== picture.generation) state.previous = state.a;
      if (state.a?.generation !== picture.generation) outdate();
      state.a = picture;
      if (first) state.tone = picture.display;
      pan.resize(picture.size);
      ask();
    }
    painter.forget([state.a, state.b, state.previous, state.pinned]);
    if (!state.a) return drawn();
    if (isBetter && painter.drawInParts) return refine(drawn);
    afterDrawing.push(drawn);
    redraw();
  },
  words(message) {
    if (message.title !== undefined) controls.title(message.title);
    if (message.status !== undefined) controls.status(message.status);
    if (message.problems) problems(message.problems);
    if (message.params) params(message.params, message.line, (command) => wire.ask(command));
    if (message.layers) {
      [state.layers, state.layer] = [message.layers, message.layer];
      controls.layers();
    }
    if (message.camera !== undefined) camera.tell(message.camera);
    if (message.pixel) {
      state.reply = { ...message.pixel, key: `${message.pixel.at} ${message.pixel.side}` };
      redraw();
    }
  },
  state(now) { controls.connection(now); },
});

new ResizeObserver(() => (pan.fits ? pan.fit() : redraw())).observe(canvas);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
