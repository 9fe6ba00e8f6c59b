// The bar below the picture, and the handle of the wipe.

import { $ } from "./panels.js";

export function bar(state, pan, act) {
  const views = [...document.querySelectorAll("#views button")];
  views.forEach((button) => button.addEventListener("click", () => act.view(button.dataset.view)));
  $("ev").addEventListener("input", () => act.exposure(Number($("ev").value)));
  $("exposure").addEventListener("dblclick", () => act.exposure(0));
  $("tone").addEventListener("change", () => act.tone($("tone").value));
  $("layer").addEventListener("change", () => act.layer($("layer").value || null));
  $("compare").addEventListener("change", () => act.compare($("compare").value));
  $("pin").addEventListener("click", act.pin);
  $("bins-on").addEventListener("click", act.histogram);
  $("zoom").addEventListener("click", () => (pan.fits ? act.oneToOne() : act.fit()));
  $("help-on").addEventListener("click", act.help);

  // The keyboard stays with the picture: Space shows the other one.
  $("bar").addEventListener("click", ({ detail, target }) => detail && target.closest("button")?.blur());
  $("bar").addEventListener("change", ({ target }) => target.blur());

  const wipe = $("wipe");
  wipe.addEventListener("pointerdown", (event) => wipe.setPointerCapture(event.pointerId));
  wipe.addEventListener("pointermove", (event) => {
    if (!wipe.hasPointerCapture(event.pointerId)) return;
    const box = pan.canvas.getBoundingClientRect();
    act.wipe((event.clientX - box.left) / box.width);
  });

  let told = "", away = "";
  const say = () => ($("status").textContent = $("about").title = away || told);
  const press = (id, on) => $(id).setAttribute("aria-pressed", Boolean(on));

  return {
    update() {
      for (const button of views) {
        button.setAttribute("aria-pressed", button.dataset.view === state.view);
        if (button.dataset.view === "difference") button.disabled = !state.other;
        if (button.dataset.view === "error") button.disabled = !state.a.hasError;
      }
      $("ev").value = state.ev;
      const stops = state.ev.toFixed(1).replace("-", "−");
      $("stops").value = state.ev > 0.04 ? `+${stops}` : stops;
      $("tone").value = state.tone;
      for (const option of $("compare").options) option.hidden = option.disabled = option.value !== "off" && !state[option.value];
      $("compare").value = state.compare;
      press("bins-on", state.bins);
      press("pin", state.compare === "pinned");
      const share = pan.zoom * devicePixelRatio * 100;
      $("zoom").textContent = pan.fits ? "Fit" : `${share < 10 ? share.toFixed(1) : Math.round(share)} %`;
      const { samples, of_samples: of, complete } = state.a;
      $("progress").style.width = complete || !of ? "100%" : `${(100 * samples) / of}%`;
      $("progress").style.opacity = complete ? 0 : 1;
    },
    layers() {
      const options = [["", "Picture"], ...state.layers.map((name) => [name, name])];
      $("layer").replaceChildren(...options.map(([value, text]) => new Option(text, value)));
      $("layer").value = state.layer ?? "";
      $("layer").hidden = state.layers.length === 0;
    },
    title(text) {
      $("title").textContent = text || "Luxel";
      document.title = text ? `${text} · Luxel` : "Luxel";
    },
    status(text) { told = text; say(); },
    connection(now) {
      away = { here: "", away: "the program does not answer …", gone: "the program has ended; this is its last picture" }[now];
      say();
    },
  };
}
