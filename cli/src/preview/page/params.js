// The scene's params, as sliders: moved, the scene is rendered with other values.

import { $, number } from "./panels.js";

export function params(list, moved) {
  const panel = $("params");
  panel.hidden = list.length === 0;
  const known = [...panel.querySelectorAll("input")];
  const same = known.map((input) => input.name).join() === list.map(({ name }) => name).join();
  // What is being moved is not taken out of the hand.
  if (same) return list.forEach(({ value }, i) => known[i] === document.activeElement || set(known[i], value));
  panel.replaceChildren(...list.map((param) => row(param, moved)));
}

function set(input, value) {
  input.value = value;
  input.nextElementSibling.value = `${input.step === "1" ? value : number(value, 4)} ${input.dataset.unit}`;
}

function row({ name, value, low, high, unit, whole }, moved) {
  const label = document.createElement("label"), input = document.createElement("input");
  Object.assign(input, { type: "range", name, min: low, max: high, step: whole ? 1 : (high - low) / 500 });
  input.dataset.unit = unit;
  label.append(name, input, document.createElement("output"));
  set(input, value);
  input.addEventListener("input", () => {
    set(input, input.valueAsNumber);
    moved(name, `${input.valueAsNumber} ${unit}`.trim());
  });
  return label;
}
