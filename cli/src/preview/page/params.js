// The scene's params: moved, the scene is rendered with other values. The file stays as it is.

import { $ } from "./panels.js";

// Between two values of one slider, and how long after the last what comes back is let be.
const PACE = 50;
const OWN = 600;

// Calls `send` at once, then at most every PACE ms; the last always.
export function paced(send) {
  let timer = 0, next = null;
  const go = () => {
    timer = 0;
    if (!next) return;
    send(...next);
    next = null;
    timer = setTimeout(go, PACE);
  };
  return (...args) => {
    next = args;
    if (!timer) go();
  };
}

let rows = new Map();

export function params(list, line, ask) {
  $("params").hidden = list.length === 0;
  $("params-on").hidden = list.length === 0;
  const keys = list.map(({ name, kind, limits, unit, list }) => JSON.stringify([name, kind, limits, unit, list])).join();
  if (keys !== $("rows").dataset.keys) {
    rows = new Map(list.map((param) => [param.name, row(param, ask)]));
    $("rows").dataset.keys = keys;
    $("rows").replaceChildren(...[...rows.values()].map(({ label }) => label));
  }
  list.forEach((param) => rows.get(param.name).show(param));
  $("set-line").hidden = $("params-reset").hidden = line === "";
  $("set-text").textContent = line;
}

// A step of which a range holds a few hundred, and that is short to write.
function step(low, high) {
  const exact = (high - low) / 400, power = 10 ** Math.floor(Math.log10(exact));
  return [1, 2, 5, 10].find((n) => n * power >= exact * 0.999) * power;
}

// The number as it is written: whole steps, but never beyond the ends.
export function snapped(value, { limits: [low, high], inclusive, whole }) {
  const by = whole ? 1 : step(low, high), places = Math.max(0, -Math.floor(Math.log10(by)));
  const near = Math.abs(high - low) * 1e-9;
  let steps = Math.round(value / by);
  if (steps * by > high + near || (!inclusive && steps * by >= high - near)) steps -= 1;
  if (steps * by < low - near) steps += 1;
  // An end that is no whole step can be reached too.
  const end = [low, ...(inclusive ? [high] : [])].find((end) => Math.abs(value - end) <= near && Math.abs(steps * by - end) > near);
  return String(end ?? Number((steps * by).toFixed(places)));
}

function row(param, ask) {
  const several = param.kind === "numbers" || param.kind === "color";
  const label = document.createElement(several ? "div" : "label"), name = document.createElement("span");
  const out = document.createElement("output");
  name.textContent = param.name;
  label.title = param.doc;
  label.className = `row ${param.kind}`;
  if (several) {
    label.role = "group";
    label.ariaLabel = param.name;
  }
  const send = paced((value) => ask({ set: { name: param.name, value } }));
  let last = 0;
  const tell = (value) => {
    last = Date.now();
    send(value);
  };
  const { fields, show } = (several ? many : single)(param, tell, out);
  let latest, timer = 0;
  // What is in the hand is not taken out of it.
  const settle = () => {
    clearTimeout(timer);
    const rest = OWN - (Date.now() - last);
    if (rest > 0) timer = setTimeout(settle, rest);
    else show(latest);
  };
  const back = document.createElement("button");
  Object.assign(back, { type: "button", textContent: "↺", title: "As the file says" });
  back.setAttribute("aria-label", `${param.name} as the file says`);
  back.addEventListener("click", (event) => {
    event.preventDefault();
    last = 0;
    send(null);
  });
  label.append(name, fields, out, back);
  return {
    label,
    show({ value, set }) {
      back.disabled = !set;
      label.classList.toggle("set", set);
      latest = value;
      settle();
    },
  };
}

const inHand = (input) => input.type === "text" && document.activeElement === input;

function field(param, inputMode = "text") {
  const input = Object.assign(document.createElement("input"), { type: "text", name: param.name, spellcheck: false, inputMode });
  input.autocomplete = "off";
  return input;
}

// One control: a slider, a box or a field.
function single(param, tell, out) {
  const input = field(param, param.kind === "number" ? "decimal" : "text");
  const behind = param.unit ? ` ${param.unit}` : "";
  const ranged = param.kind === "number" && param.limits;
  if (ranged) {
    const [low, high] = param.limits;
    Object.assign(input, { type: "range", min: low, max: high, step: param.whole ? 1 : "any" });
    const shown = () => (out.value = snapped(input.valueAsNumber, param).replace("-", "−") + behind);
    input.addEventListener("input", () => {
      shown();
      tell(snapped(input.valueAsNumber, param) + behind);
    });
    // Without steps of its own a range would take the browser's, which are coarse.
    input.addEventListener("keydown", (event) => {
      const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (!way || param.whole) return;
      event.preventDefault();
      input.value = input.valueAsNumber + way * step(low, high) * (event.shiftKey ? 10 : 1);
      input.dispatchEvent(new Event("input"));
    });
  } else if (param.kind === "bool") {
    input.type = "checkbox";
    input.addEventListener("change", () => tell(String(input.checked)));
  } else {
    out.value = behind;
    input.addEventListener("change", () => {
      const text = input.value.trim();
      if (param.kind === "text") tell(input.value);
      // With a unit of its own, as it stands.
      else if (text) tell(isNumber(text) ? plain(text) + behind : text);
    });
  }
  const show = (value) => {
    if (inHand(input)) return;
    if (param.kind === "bool") input.checked = value;
    else input.value = value;
    if (ranged) out.value = String(param.whole ? value : Number(value.toPrecision(4))).replace("-", "−") + behind;
  };
  return { fields: input, show };
}

const isNumber = (text) => text !== "" && Number.isFinite(Number(text));
// As a scene writes it: `5.` and `+1` are numbers here alone.
const plain = (text) => String(Number(text)).replace("+", "");

// What a screen is given for linear sRGB, and the other way.
const encoded = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const hex = (rgb) => `#${rgb.map((x) => Math.round(Math.min(Math.max(encoded(x), 0), 1) * 255).toString(16).padStart(2, "0")).join("")}`;
const decoded = (hex) => [1, 3, 5].map((i) => Number((parseInt(hex.slice(i, i + 2), 16) / 255).toFixed(4)));

// A row of numbers: those of a vector or a list, or of a colour, behind a field that picks one.
function many(param, tell, out) {
  const isColour = param.kind === "color", behind = param.unit ? ` ${param.unit}` : "";
  const [open, close] = isColour ? ["rgb.linear_srgb(", ")"] : param.list ? ["[", "]"] : ["(", ")"];
  const fields = document.createElement("span");
  fields.className = "fields";
  out.value = behind;
  const exact = [];
  const picker = Object.assign(document.createElement("input"), { type: "color", name: `${param.name}-colour`, title: "Linear sRGB stands beside it" });
  picker.setAttribute("aria-label", `${param.name}, sRGB`);
  picker.addEventListener("input", () => tell(`rgb.srgb(${decoded(picker.value).join(", ")})`));
  if (isColour) fields.append(picker);
  const rounded = (x) => (isColour ? String(Number(x.toPrecision(4))) : String(x));
  // What is rounded for the eye is not sent so.
  const told = () => {
    const texts = inputs.map((input, i) => (input.value === rounded(exact[i]) ? String(exact[i]) : input.value.trim()));
    if (texts.includes("")) return;
    if (texts.every(isNumber)) tell(open + texts.map(plain).join(", ") + close + behind);
    // With units of their own, as they stand.
    else tell(open + texts.map((text) => (isNumber(text) ? plain(text) + behind : text)).join(", ") + close);
  };
  let inputs = [];
  const show = (value) => {
    if (inputs.length !== value.length) {
      inputs.forEach((input) => input.remove());
      inputs = value.map((_, i) => {
        const input = field({ name: `${param.name}-${i}` }, "decimal");
        input.setAttribute("aria-label", `${param.name}, ${isColour ? ["red", "green", "blue"][i] : i + 1}`);
        input.addEventListener("change", told);
        return input;
      });
      fields.append(...inputs);
    }
    inputs.forEach((input, i) => {
      if (inHand(input)) return;
      exact[i] = value[i];
      input.value = rounded(value[i]);
    });
    if (isColour) picker.value = hex(value);
  };
  return { fields, show };
}
