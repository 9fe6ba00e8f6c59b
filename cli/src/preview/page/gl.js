// Drawing with WebGL 2: one triangle, textures of halves as they came.

import { ERROR, LUMINANCE, MAPS, ROWS, SHARE, SIGMAS, STEPS } from "./maps.js";
import { FRAGMENT, VERTEX } from "./shader.js";

const VIEWS = ["colour", "luminance", "error", "difference"];
const TONES = ["srgb", "linear", "filmic"];

export function withGl(canvas) {
  const gl = canvas.getContext("webgl2", { alpha: true, antialias: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => location.reload());
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.bindVertexArray(gl.createVertexArray());
  const places = {};
  const at = (name) => (places[name] ??= gl.getUniformLocation(program, name));
  ["rgbA", "seA", "rgbB", "seB", "maps"].forEach((name, i) => gl.uniform1i(at(name), i));

  function texture(filter) {
    const made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, filter);
    for (const key of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, key, gl.CLAMP_TO_EDGE);
    return made;
  }
  function plane(width, height, halves) {
    const made = texture(gl.LINEAR);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB16F, width, height, 0, gl.RGB, gl.HALF_FLOAT, halves);
    return made;
  }
  const maps = texture(gl.NEAREST);
  const rows = new Uint8Array(ROWS.length * STEPS * 4);
  ROWS.forEach((name, i) => rows.set(MAPS[name], i * STEPS * 4));
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, STEPS, ROWS.length, 0, gl.RGBA, gl.UNSIGNED_BYTE, rows);
  const nothing = plane(1, 1, new Uint16Array(3));
  const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);

  const held = new Map();
  function planes(picture) {
    if (!held.has(picture)) {
      const { width, height, rgb, se } = picture;
      if (width > most || height > most) throw new Error(`a side of more than ${most} pixels is too long for this browser`);
      held.set(picture, [plane(width, height, rgb), picture.hasError ? plane(width, height, se) : nothing]);
    }
    return held.get(picture);
  }

  return {
    forget(kept) {
      for (const [picture, textures] of held) {
        if (kept.includes(picture)) continue;
        textures.filter((each) => each !== nothing).forEach((each) => gl.deleteTexture(each));
        held.delete(picture);
      }
    },
    draw(state, { x, y, zoom }, ratio) {
      const { a, other } = state;
      const textures = [...planes(a), ...(other ? planes(other) : [nothing, nothing]), maps];
      textures.forEach((each, i) => {
        gl.activeTexture(gl.TEXTURE0 + i);
        gl.bindTexture(gl.TEXTURE_2D, each);
      });
      for (const [picture, letter] of [[a, "A"], [other ?? a, "B"]]) {
        const scale = picture.unit * state.scaleOf();
        gl.uniform4fv(at(`window${letter}`), picture.window);
        gl.uniform3f(at(`unit${letter}`), scale, picture.hasError ? 1 : 0, picture.step);
      }
      gl.uniform2fv(at("size"), a.size);
      gl.uniform2f(at("corner"), x * ratio, y * ratio);
      gl.uniform1f(at("zoom"), zoom * ratio);
      gl.uniform1f(at("wipe"), state.wipe * canvas.width);
      gl.uniform1f(at("height"), canvas.height);
      gl.uniform1i(at("view"), VIEWS.indexOf(state.view));
      gl.uniform1i(at("tone"), TONES.indexOf(state.tone));
      gl.uniform1i(at("sides"), other ? (state.flipped ? 2 : 1) : 0);
      gl.uniform4f(at("surround"), 0.06, 0.06, 0.06, 0.12);
      gl.uniform4f(at("scales"), ...LUMINANCE, ...ERROR);
      gl.uniform2f(at("spread"), SIGMAS, SHARE);
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    },
  };
}
