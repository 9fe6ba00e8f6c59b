// The camera in the hand: turned about a point, moved along the picture, brought closer. The program
// renders from where it stands; the file stays as it is, and what to paste there is shown.

import { $ } from "./panels.js";
import { paced } from "./params.js";

const TURN = 0.007;
// So close to straight up or down, and no closer.
const POLE = 0.01;
// What comes back so long after the last move is older than what is in the hand.
const OWN = 600;
// The program takes no more and no less.
const MOST_ZOOM = 1e9;

const add = (a, b, k = 1) => a.map((x, i) => x + k * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => a.map((x) => x / length(a));
// About a unit axis.
const turned = (v, axis, angle) => {
  const [c, s] = [Math.cos(angle), Math.sin(angle)], along = dot(axis, v) * (1 - c), side = cross(axis, v);
  return v.map((x, i) => x * c + side[i] * s + axis[i] * along);
};

export function orbited(view, dx, dy) {
  const { from, to, up } = view;
  const axis = unit(up), off = add(from, to, -1), side = unit(cross(axis, off));
  const polar = Math.acos(Math.min(Math.max(dot(unit(off), axis), -1), 1));
  const tilt = Math.min(Math.max(polar - dy * TURN, POLE), Math.PI - POLE) - polar;
  return { ...view, from: add(to, turned(turned(off, side, tilt), axis, -dx * TURN)) };
}

// `metres` is what a pixel of the screen is where the camera looks.
export function panned(view, dx, dy, metres) {
  const { from, to, up } = view;
  const back = unit(add(from, to, -1)), right = unit(cross(up, back)), over = cross(back, right);
  const by = add(right.map((x) => -x * dx * metres), over, dy * metres);
  return { ...view, from: add(from, by), to: add(to, by) };
}

// A camera whose rays are parallel comes no closer: it shows less.
export function dollied(view, factor) {
  const { from, to, zoom } = view;
  if (zoom) return { ...view, zoom: Math.min(Math.max(zoom * factor, 1 / MOST_ZOOM), MOST_ZOOM) };
  return { ...view, from: add(to, add(from, to, -1), factor) };
}

export class Camera {
  constructor(ask, pan) {
    Object.assign(this, { told: null, view: null, on: false, last: 0, pan });
    this.send = paced((view) => ask({ camera: { view } }));
  }

  // As the program tells it.
  tell(camera) {
    this.told = camera;
    $("camera-on").hidden = !camera;
    if (!camera) this.on = false;
    const own = Date.now() - this.last < OWN;
    if (camera && !(own && this.view)) {
      const { from, to, up, zoom } = camera;
      this.view = zoom ? { from, to, up, zoom } : { from, to, up };
    }
    this.show();
  }

  show() {
    const moved = Boolean(this.told?.moved);
    $("camera").hidden = !(this.on || moved);
    $("camera-on").setAttribute("aria-pressed", this.on);
    $("camera-text").textContent = this.told?.text ?? "";
    $("camera-reset").disabled = !moved;
    this.pan.canvas.classList.toggle("steered", this.on);
  }

  toggle() {
    this.on = Boolean(this.told) && !this.on;
    this.show();
  }

  // Whether a drag that begins so steers it.
  steers({ button, altKey }) {
    return Boolean(this.told && this.view && (this.on || altKey || button === 2));
  }

  become(view) {
    if (![...view.from, ...view.to].every(Number.isFinite)) return;
    this.view = view;
    this.last = Date.now();
    this.send(view);
  }

  get metres() {
    const { spread } = this.told, far = length(add(this.view.from, this.view.to, -1));
    return (spread[0] + spread[1] * far) / this.pan.zoom;
  }

  orbit(dx, dy) { this.become(orbited(this.view, dx, dy)); }
  move(dx, dy) { this.become(panned(this.view, dx, dy, this.metres)); }
  dolly(factor) { this.become(dollied(this.view, factor)); }

  reset() {
    if (!this.told?.moved && Date.now() - this.last >= OWN) return false;
    this.last = 0;
    this.send(null);
    return true;
  }
}
