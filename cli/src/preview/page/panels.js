// What lies over the picture: a pixel's values, the histogram, the legend, what went wrong.

import { copy } from "./copy.js";
import { ERROR, LUMINANCE, MAPS, SHARE, SIGMAS } from "./maps.js";
import { luminance } from "./picture.js";
import { apart, relative, show } from "./shade.js";

export const $ = (id) => document.getElementById(id);

export function number(v, digits = 4) {
  if (!Number.isFinite(v)) return Number.isNaN(v) ? "nan" : v > 0 ? "∞" : "−∞";
  const size = Math.abs(v);
  const odd = size !== 0 && (size < 1e-3 || size >= 1e6);
  const text = odd ? v.toExponential(digits - 1) : size >= 10 ** digits ? v.toFixed(0) : v.toPrecision(digits);
  return text.replace("-", "−").replace("e+", "e");
}

const percent = (v) => (Number.isFinite(v) ? `${number(v * 100, 3)} %` : "unknown");

function element(name, text, kind) {
  const made = document.createElement(name);
  made.textContent = text;
  if (kind) made.className = kind;
  return made;
}

// Numbers as the program writes them.
const exact = (text) => text.split(" ").map((v) => Number(v.replace("inf", "Infinity")));

// `reply` is what the program says of the pixel: exact values, where the page has rounded ones.
export function inspect(state, at, side, reply, held) {
  const picture = side === "b" && state.other ? state.other : state.a;
  const i = at && picture ? picture.index(...at) : -1;
  const panel = $("inspector");
  panel.hidden = i < 0;
  if (i < 0) return;
  panel.classList.toggle("held", held);
  let rgb = picture.radiance(i), se = picture.error(i);
  const n = picture.samplesOf(i);
  $("where").textContent = `${at[0]}, ${at[1]}`;
  const colour = show(rgb.map((x) => x * state.scaleOf()), state.tone).map(Math.round);
  $("swatch").style.background = `rgb(${colour.join()})`;
  const facts = [];
  if (picture.layer) return tell((reply?.facts ?? []).map(([name, text]) => [name, text, name === picture.layer ? "line" : ""]), reply, held);
  const known = Object.fromEntries(reply?.facts ?? []);
  const texts = known.radiance?.split(" ") ?? rgb.map((v) => number(v));
  if (known.radiance) rgb = exact(known.radiance);
  if (se && known["standard error"]) se = exact(known["standard error"]);
  texts.forEach((text, c) => facts.push(["RGB"[c], text, "rgb"[c]]));
  facts.push(["luminance", number(luminance(...rgb))]);
  if (se) {
    facts.push(["standard error", se.map((v) => number(v, 3)).join(" "), "line"]);
    facts.push(["relative", percent(relative(rgb, se))]);
  }
  if (n) facts.push(["samples", known.samples ?? String(n)]);
  if (state.other && picture === state.a) {
    const j = state.other.index(...at);
    if (j >= 0) {
      const there = [state.other.radiance(j), state.other.error(j)];
      facts.push([`luminance, ${state.otherName}`, number(luminance(...there[0])), "line"]);
      const scale = se && there[1] ? SIGMAS : NaN, d = apart([rgb, se], there) * scale;
      if (Number.isFinite(d)) facts.push(["difference", `${number(d, 2)} σ`]);
    }
  }
  const more = (reply?.facts ?? []).filter(([name]) => !["radiance", "standard error", "samples"].includes(name));
  more.forEach(([name, text], k) => facts.push([name, text, k ? "" : "line"]));
  tell(facts, reply, held);
}

// What did not change stays, so that it can be clicked.
function tell(facts, reply, held) {
  const places = new Map((reply?.places ?? []).map(([name, place, address]) => [name, { place, address }]));
  const key = JSON.stringify([facts, [...places], held]);
  if (key === $("facts").dataset.key) return;
  $("facts").dataset.key = key;
  $("facts").replaceChildren(...facts.flatMap(([name, text, kind]) => [element("dt", name, kind), fact(text, kind, places.get(name))]));
}

// A place is told without its folders. It is a link where there is an editor to open it, else it can be copied.
const EDITOR = /^(?!(javascript|data|vbscript|https?|file|blob):)[a-z][a-z0-9+.-]*:\/\//;
function fact(text, kind, where) {
  const made = element("dd", where ? text.slice(0, text.length - where.place.length) : text, kind);
  if (!where) return made;
  const short = where.place.replace(/^.*[/\\]/, "");
  if (where.address && EDITOR.test(where.address)) {
    const link = element("a", short);
    Object.assign(link, { href: where.address, title: `Open ${where.place}` });
    made.append(link);
  } else {
    const button = element("button", "Copy");
    button.title = `Copy ${where.place}`;
    button.addEventListener("click", () => copy(where.place, button));
    const place = Object.assign(element("span", short), { title: where.place });
    made.append(place, button);
  }
  return made;
}

const BINS = 120;
const STOPS = [-12, 4];
const MOST_PIXELS = 200000;

let counted = "";
export function histogram(state) {
  const canvas = $("bins"), ratio = devicePixelRatio;
  const [w, h] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const picture = state.shownPicture, scale = state.scaleOf();
  // Counting takes longer than drawing: once is enough.
  const key = [picture.serial, scale, w, h, dark].join();
  if (key === counted) return;
  counted = key;
  Object.assign(canvas, { width: w, height: h });
  const bins = [0, 1, 2].map(() => new Float64Array(BINS));
  let clipped = 0, all = 0;
  for (const rgb of picture.spread(MOST_PIXELS)) {
    all += 1;
    if (rgb.some((v) => v * scale > 1)) clipped += 1;
    rgb.forEach((v, c) => {
      const t = (Math.log2(v * scale) - STOPS[0]) / (STOPS[1] - STOPS[0]);
      if (t >= 0 && t < 1) bins[c][Math.floor(t * BINS)] += 1;
    });
  }
  const top = Math.max(1, ...bins.flatMap((bin) => [...bin]));
  const context = canvas.getContext("2d");
  context.globalCompositeOperation = dark ? "lighter" : "multiply";
  const colours = dark ? ["#8f3a33", "#33703f", "#375794"] : ["#f2a79e", "#a5d9ae", "#aac2f5"];
  bins.forEach((bin, c) => {
    context.fillStyle = colours[c];
    context.beginPath();
    context.moveTo(0, h);
    bin.forEach((n, i) => context.lineTo(((i + 0.5) / BINS) * w, h - Math.sqrt(n / top) * (h - ratio)));
    context.lineTo(w, h);
    context.fill();
  });
  context.globalCompositeOperation = "source-over";
  context.fillStyle = dark ? "#fff7" : "#0006";
  context.fillRect(((0 - STOPS[0]) / (STOPS[1] - STOPS[0])) * w, 0, ratio, h);
  $("range-low").textContent = `${STOPS[0]}`.replace("-", "−");
  $("range-high").textContent = `+${STOPS[1]} stops`;
  $("clipped").textContent = `${number((clipped / all) * 100, 2)} % above white`;
}

export function legend(state) {
  const { view, a, other } = state;
  $("legend").hidden = view === "colour" || !a;
  if ($("legend").hidden) return;
  const white = 1 / state.scaleOf();
  const sigmas = a.hasError && other?.hasError;
  const [quantity, ticks] = {
    luminance: () => [a.layer ? `Luminance of ${a.layer} as it is shown` : "Luminance, W/m²/sr", stops().map((stop) => number(white * 2 ** stop, 2))],
    error: () => (a.hasError ? ["Relative standard error", decades()] : ["This picture does not say how wrong it may be", []]),
    difference: () => [sigmas ? "Difference, in standard errors" : "Difference of luminance", ends(sigmas)],
  }[view]();
  $("quantity").textContent = quantity;
  $("ramp").getContext("2d").putImageData(new ImageData(MAPS[view].slice(), MAPS[view].length / 4, 1), 0, 0);
  $("ticks").replaceChildren(...ticks.map((text) => element("span", text)));
}

const stops = () => [0, 0.25, 0.5, 0.75, 1].map((t) => LUMINANCE[0] + t * (LUMINANCE[1] - LUMINANCE[0]));
const decades = () => [-3, -2, -1, 0].slice(0, ERROR[1] - ERROR[0] + 1).map((d) => `${Number((100 * 10 ** d).toPrecision(1))} %`);
const ends = (sigmas) => (sigmas ? [`−${SIGMAS} σ`, "0", `+${SIGMAS} σ`] : [`−${SHARE * 100} %`, "0", `+${SHARE * 100} %`]);

// The first line of a message is its head.
export function problems(list) {
  $("problems").hidden = list.length === 0;
  $("problems").replaceChildren(...list.map(({ severity, text }) => {
    const [head, ...rest] = text.split("\n");
    const block = element("pre", "", severity);
    block.append(element("b", head), ["", ...rest].join("\n"));
    return block;
  }));
}
