// Where the picture lies on the canvas: fit, zoom, drag, pinch. Lengths are CSS pixels.

const MARGIN = 14;
const MOST = 128;

export class Pan {
  // `camera` is what some drags steer instead.
  constructor(canvas, { changed, tapped, hovered, wheeled, camera }) {
    Object.assign(this, { canvas, changed, x: 0, y: 0, zoom: 1, fits: true, size: [1, 1] });
    const fingers = new Map();
    let moved = 0, steering = false;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener("pointerdown", (event) => {
      const steers = camera().steers(event);
      if (event.button > 1 && !steers) return;
      canvas.setPointerCapture(event.pointerId);
      if (fingers.size === 0) [moved, steering] = [0, steers];
      fingers.set(event.pointerId, place(event));
      if (fingers.size > 1) moved = Infinity;
    });
    canvas.addEventListener("pointermove", (event) => {
      const now = place(event), last = fingers.get(event.pointerId);
      if (!last) return event.pointerType === "mouse" && hovered(this.pixelAt(...now));
      const others = [...fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      fingers.set(event.pointerId, now);
      moved += Math.hypot(now[0] - last[0], now[1] - last[1]);
      if (moved < 4) return;
      canvas.classList.add("dragged");
      const by = [now[0] - last[0], now[1] - last[1]];
      if (others.length === 0 && steering) return event.shiftKey ? camera().move(...by) : camera().orbit(...by);
      if (others.length === 0) return this.move(...by);
      const away = (at) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]);
      const middle = (at) => [(at[0] + others[0][0]) / 2, (at[1] + others[0][1]) / 2];
      const [from, to] = [middle(last), middle(now)];
      if (steering) {
        camera().move(to[0] - from[0], to[1] - from[1]);
        return camera().dolly(Math.max(away(last), 1) / Math.max(away(now), 1));
      }
      this.move(to[0] - from[0], to[1] - from[1]);
      this.zoomBy(away(now) / Math.max(away(last), 1), ...to);
    });
    const up = (event) => {
      const at = fingers.get(event.pointerId);
      if (!fingers.delete(event.pointerId)) return;
      canvas.classList.remove("dragged");
      if (event.type === "pointerup" && moved < 4 && event.button === 0) tapped(this.pixelAt(...at));
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("pointerleave", () => fingers.size || hovered(null));
    canvas.addEventListener("contextmenu", (event) => camera().told && event.preventDefault());
    canvas.addEventListener("dblclick", () => (this.fits ? this.oneToOne() : this.fit()));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (event.altKey && !camera().on) return wheeled(-Math.sign(event.deltaY));
      const lines = event.deltaMode ? 30 : 1;
      const notch = Math.max(-60, Math.min(60, event.deltaY * lines));
      const factor = 2 ** (-notch / (event.ctrlKey ? 40 : 160));
      if (camera().on) return camera().dolly(1 / factor);
      this.zoomBy(factor, ...place(event));
    }, { passive: false });
  }

  get room() { return [this.canvas.clientWidth, this.canvas.clientHeight]; }

  // The size of the picture, which stays where it is when it stays the same.
  resize(size) {
    if (size.join() === this.size.join()) return;
    this.size = size;
    this.fit();
  }

  fit() {
    const [w, h] = this.room, [pw, ph] = this.size;
    const zoom = Math.max(Math.min((w - 2 * MARGIN) / pw, (h - 2 * MARGIN) / ph), 1e-3);
    Object.assign(this, { zoom: Math.min(zoom, MOST), fits: true });
    this.centre();
  }

  // A pixel of the picture is a pixel of the screen.
  oneToOne() {
    Object.assign(this, { zoom: 1 / devicePixelRatio, fits: false });
    this.centre();
  }

  centre() {
    const [w, h] = this.room, [pw, ph] = this.size;
    [this.x, this.y] = [Math.round((w - pw * this.zoom) / 2), Math.round((h - ph * this.zoom) / 2)];
    this.changed();
  }

  move(dx, dy) {
    const [w, h] = this.room, [pw, ph] = this.size, keep = 40;
    this.x = Math.min(Math.max(this.x + dx, keep - pw * this.zoom), w - keep);
    this.y = Math.min(Math.max(this.y + dy, keep - ph * this.zoom), h - keep);
    this.fits = false;
    this.changed();
  }

  // About a point of the canvas, the middle if there is none.
  zoomBy(factor, x = this.room[0] / 2, y = this.room[1] / 2) {
    const least = Math.min(0.05, this.room[0] / this.size[0] / 4);
    const zoom = Math.min(Math.max(this.zoom * factor, least), MOST), k = zoom / this.zoom;
    Object.assign(this, { x: x - (x - this.x) * k, y: y - (y - this.y) * k, zoom, fits: false });
    this.move(0, 0);
  }

  pixelAt(x, y) {
    const at = [Math.floor((x - this.x) / this.zoom), Math.floor((y - this.y) / this.zoom)];
    return at.every((v, i) => v >= 0 && v < this.size[i]) ? at : null;
  }
}
