// The picture's shader. Exposure, tone and false colour cost no new rays and no new picture.

export const VERTEX = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4. - 1., 0., 1.); }`;

// What is drawn is a constant of the program: without a graphics card whatever stands in one is worked
// out for each point of the screen, wanted or not. `shrunk`: whether some point shows more than a pixel.
export const fragment = ({ view, tone, sides, shrunk }) => `#version 300 es
precision highp float;
const int view = ${view}, tone = ${tone}, sides = ${sides};   // sides: 0 A alone, 1 wipe, 2 B alone
const bool shrunk = ${shrunk};
precision highp sampler2D;
uniform sampler2D rgbA, seA, rgbB, seB, maps;
uniform vec4 windowA, windowB;   // in pixels of the whole picture
uniform vec3 unitA, unitB;       // of radiance with exposure; whether there is an error; step of a coarse picture
uniform vec2 size, corner;       // of the whole picture; of its upper left on the canvas
uniform float zoom, wipe, height;
uniform vec4 surround;
uniform vec4 scales;             // luminance from, to; error from, to
uniform vec2 spread;             // standard errors, share at the end of the scale
out vec4 colour;

const mat3 AGX = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                      0.0784335999999992, 0.878468636469772, 0.0784336,
                      0.0792237451477643, 0.0791661274605434, 0.879142973793104);
vec3 curve(vec3 x) {
  vec3 t = (clamp(log2(max(x, 1e-30)), -12.47393, 4.026069) + 12.47393) / 16.499999;
  return ((((((15.5 * t - 40.14) * t + 31.96) * t - 6.868) * t + 0.4298) * t + 0.1191) * t) - 0.00232;
}
vec3 srgb(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(x, vec3(1. / 2.4)) - 0.055, step(0.0031308, x));
}
vec3 show(vec3 x) {
  x = min(x, vec3(1e30));
  if (tone == 2) return clamp(inverse(AGX) * curve(AGX * x), 0., 1.);
  x = clamp(x, 0., 1.);
  return tone == 0 ? srgb(x) : x;
}
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
vec3 map(int row, float t) {
  if (isnan(t)) return vec3(1., 0., 1.);
  return texelFetch(maps, ivec2(int(clamp(t, 0., 1.) * 255. + .5), row), 0).rgb;
}

// The mean over one pixel of the screen of what lies below it.
vec3 look(sampler2D plane, vec4 window, float coarse, vec2 p) {
  vec2 size = vec2(textureSize(plane, 0));
  float step = 1. / zoom;
  if (!shrunk || step <= coarse) {
    vec2 q = (p - window.xy) / coarse, f = fract(q);
    float px = zoom * coarse;
    q = floor(q) + clamp(f * px, 0., .5) + clamp((f - 1.) * px + .5, 0., .5);
    return texture(plane, q / size).rgb;
  }
  int taps = int(min(ceil(step / coarse), 8.));
  vec3 sum = vec3(0.);
  for (int j = 0; j < taps; j++) for (int i = 0; i < taps; i++) {
    vec2 q = p + (vec2(i, j) + .5) / float(taps) * step - .5 * step - window.xy;
    sum += texture(plane, q / coarse / size).rgb;
  }
  return sum / float(taps * taps);
}
bool inside(vec2 p, vec4 w) { return all(greaterThanEqual(p, w.xy)) && all(lessThan(p, w.xy + w.zw)); }

void main() {
  vec2 at = vec2(gl_FragCoord.x, height - gl_FragCoord.y);
  vec2 p = (at - corner) / zoom;
  if (!inside(p, vec4(0., 0., size))) { colour = vec4(0.); return; }
  bool other = sides == 2 || (sides == 1 && at.x > wipe && view != 3);
  vec4 w = other ? windowB : windowA;
  if (!inside(p, w)) { colour = surround; return; }
  vec3 rgb = other ? look(rgbB, windowB, unitB.z, p) : look(rgbA, windowA, unitA.z, p);
  vec3 unit = other ? unitB : unitA;
  vec3 shown;
  if (view == 1) {
    shown = map(0, (log2(luminance(rgb) * unit.x) - scales.x) / (scales.y - scales.x));
  } else if (view == 2) {
    vec3 se = other ? look(seB, windowB, unitB.z, p) : look(seA, windowA, unitA.z, p);
    float r = luminance(se) / abs(luminance(rgb));
    shown = unit.y > 0. ? map(1, (log2(r) / 3.321928094887362 - scales.z) / (scales.w - scales.z)) : vec3(1., 0., 1.);
  } else if (view == 3) {
    float a = luminance(rgb) * unit.x, b = luminance(look(rgbB, windowB, unitB.z, p)) * unitB.x;
    float sa = luminance(look(seA, windowA, unitA.z, p)) * unitA.x, sb = luminance(look(seB, windowB, unitB.z, p)) * unitB.x;
    float sigma = length(vec2(sa, sb));
    float d = unitA.y * unitB.y > 0. && !isinf(sigma) ? (a - b) / (sigma * spread.x) : (a - b) / (max(abs(a), abs(b)) * spread.y);
    shown = map(2, a == b ? .5 : d * .5 + .5);
  } else {
    vec3 exposed = rgb * unit.x;
    shown = any(isnan(exposed)) ? vec3(1., 0., 1.) : show(exposed);
  }
  colour = vec4(shown, 1.);
}`;
