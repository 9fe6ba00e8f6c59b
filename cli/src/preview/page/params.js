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
  const keys = list.map(({ name, kind, limits, unit }) => JSON.stringify([name, kind, limits, unit])).join();
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
  const label = document.createElement("label"), name = document.createElement("span");
  const input = document.createElement("input"), out = document.createElement("output");
  name.textContent = param.name;
  label.title = param.doc;
  label.className = param.kind;
  input.name = param.name;
  const behind = param.unit ? ` ${param.unit}` : "";
  const send = paced((value) => ask({ set: { name: param.name, value } }));
  let last = 0;
  const tell = (value) => {
    last = Date.now();
    send(value);
  };
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
    Object.assign(input, { type: "text", spellcheck: false, inputMode: param.kind === "number" ? "decimal" : "text" });
    input.autocomplete = "off";
    out.value = behind;
    input.addEventListener("change", () => {
      const text = input.value.trim();
      if (param.kind === "text") tell(input.value);
      // With a unit of its own, as it stands.
      else if (text) tell(Number.isFinite(Number(text)) ? text + behind : text);
    });
  }
  const back = document.createElement("button");
  Object.assign(back, { type: "button", textContent: "↺", title: "As the file says" });
  back.setAttribute("aria-label", `${param.name} as the file says`);
  back.addEventListener("click", (event) => {
    event.preventDefault();
    last = 0;
    send(null);
  });
  label.append(name, input, out, back);
  return {
    label,
    // What is in the hand is not taken out of it.
    show({ value, set }) {
      back.disabled = !set;
      label.classList.toggle("set", set);
      if (Date.now() - last < OWN || (input.type === "text" && document.activeElement === input)) return;
      if (param.kind === "bool") input.checked = value;
      else input.value = value;
      if (ranged) out.value = String(param.whole ? value : Number(value.toPrecision(4))).replace("-", "−") + behind;
    },
  };
}
