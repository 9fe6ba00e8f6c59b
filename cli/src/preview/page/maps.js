// False colours, as stops between which is interpolated: viridis, inferno and a red-blue scale.

const STOPS = {
  luminance: "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725",
  error: "000004 180f3d 440f76 721f81 9e2f7f cd4071 f1605d fd9668 feca8d fcfdbf",
  difference: "2166ac 4393c3 92c5de d1e5f0 f7f7f7 fddbc7 f4a582 d6604d b2182b",
};
export const ROWS = Object.keys(STOPS);
export const STEPS = 256;

export const MAPS = Object.fromEntries(ROWS.map((name) => {
  const stops = STOPS[name].split(" ").map((hex) => [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16)));
  const table = new Uint8ClampedArray(STEPS * 4);
  for (let i = 0; i < STEPS; i++) {
    const t = (i / (STEPS - 1)) * (stops.length - 1), k = Math.min(Math.floor(t), stops.length - 2);
    for (let c = 0; c < 3; c++) table[i * 4 + c] = stops[k][c] + (stops[k + 1][c] - stops[k][c]) * (t - k);
    table[i * 4 + 3] = 255;
  }
  return [name, table];
}));

// What the ends of a scale mean. Luminance: stops about white. Error: decades of the relative error.
// Difference: standard errors, or a share where there are none.
export const LUMINANCE = [-8, 4];
export const ERROR = [-3, 0];
export const SIGMAS = 5;
export const SHARE = 0.2;
