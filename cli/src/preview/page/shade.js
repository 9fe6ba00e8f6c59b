// What a screen shows of radiance, on the processor: for the inspector, and where there is no WebGL 2.
// The same constants as in `picture/display.rs` and `shader.js`.

import { ERROR, LUMINANCE, MAPS, SHARE, SIGMAS, STEPS } from "./maps.js";
import { luminance } from "./picture.js";

const AGX = [
  [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
  [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
  [0.0423756549057051, 0.0784336, 0.879142973793104],
];
const AGX_BACK = inverse(AGX);
const CURVE = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232];

function inverse([[a, b, c], [d, e, f], [g, h, i]]) {
  const A = e * i - f * h, B = f * g - d * i, C = d * h - e * g, k = 1 / (a * A + b * B + c * C);
  return [
    [A * k, (c * h - b * i) * k, (b * f - c * e) * k],
    [B * k, (a * i - c * g) * k, (c * d - a * f) * k],
    [C * k, (b * g - a * h) * k, (a * e - b * d) * k],
  ];
}

const times = (m, v) => m.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const clip = (x) => Math.min(Math.max(x, 0), 1);
const srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const contrast = (x) => {
  const stop = x > 0 ? Math.min(Math.max(Math.log2(x), -12.47393), 4.026069) : -12.47393;
  const t = (stop + 12.47393) / 16.499999;
  return CURVE.reduce((sum, c) => sum * t + c, 0);
};

const MAGENTA = [255, 0, 255];

export function show(rgb, tone) {
  if (rgb.some(Number.isNaN)) return MAGENTA;
  const shown = tone === "filmic" ? times(AGX_BACK, times(AGX, rgb).map(contrast)) : rgb;
  return shown.map((x) => 255 * (tone === "srgb" ? srgb(clip(x)) : clip(x)));
}

export const relative = (rgb, se) => luminance(...se) / Math.abs(luminance(...rgb));

export function falseColour(name, t) {
  if (Number.isNaN(t)) return MAGENTA;
  const i = Math.round(clip(t) * (STEPS - 1)) * 4;
  return MAPS[name].subarray(i, i + 3);
}

// The colour of a pixel in a view; `other` is the pixel that it is compared with, if there is one.
export function shade(view, tone, scale, [rgb, se], other) {
  const within = (x, [low, high]) => (x - low) / (high - low);
  if (view === "luminance") return falseColour("luminance", within(Math.log2(luminance(...rgb) * scale), LUMINANCE));
  if (view === "error") return falseColour("error", se ? within(Math.log10(relative(rgb, se)), ERROR) : NaN);
  if (view === "difference") return falseColour("difference", other ? apart([rgb, se], other) * 0.5 + 0.5 : 0.5);
  return show(rgb.map((x) => x * scale), tone);
}

// Difference of luminance, one at the end of the scale.
export function apart([rgb, se], [rgb2, se2]) {
  const [a, b] = [luminance(...rgb), luminance(...rgb2)];
  if (a === b) return 0;
  const sigma = se && se2 ? Math.hypot(luminance(...se), luminance(...se2)) : Infinity;
  if (Number.isFinite(sigma)) return (a - b) / (sigma * SIGMAS);
  return (a - b) / (Math.max(Math.abs(a), Math.abs(b)) * SHARE);
}
