// The keyboard.

export function keys(act) {
  const once = {
    1: () => act.view("colour"), 2: () => act.view("luminance"), 3: () => act.view("error"), 4: () => act.view("difference"),
    0: () => act.exposure(0), a: act.autoExposure, t: act.nextTone, c: act.nextCompare, p: act.pin,
    f: act.fit, z: act.oneToOne, "+": () => act.zoom(1.5), "=": () => act.zoom(1.5), "-": () => act.zoom(1 / 1.5),
    h: act.histogram, l: act.nextLayer, o: act.camera, s: () => act.params(), "?": act.help, Escape: act.release,
  };
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const own = event.target.closest?.("#side input");
    if (own && event.key === "Escape") return own.blur();
    if (own && (own.type === "text" || /^(Arrow|Home|End|Page| )/.test(event.key))) return;
    const inField = event.target.closest?.("select, input");
    const step = event.shiftKey ? 1 : 1 / 3;
    if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      if (event.target.closest?.("select")) return;
      act.exposureBy(event.key === "ArrowUp" ? step : -step);
    } else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      if (inField) return;
      act.wipeBy((event.key === "ArrowRight" ? 1 : -1) * (event.shiftKey ? 0.1 : 0.02));
    } else if (event.key === " ") {
      if (event.target.closest?.("button, select")) return;
      act.flip(true);
    } else {
      if (event.target.closest?.("select") && event.key !== "Escape") return;
      const known = once[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!known) return;
      known();
    }
    event.preventDefault();
  });
  addEventListener("keyup", (event) => event.key === " " && act.flip(false));
  addEventListener("blur", () => act.flip(false));
}
