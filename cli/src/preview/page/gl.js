// Drawing with WebGL 2: one triangle, textures of halves as they came.

import { ERROR, LUMINANCE, MAPS, ROWS, SHARE, SIGMAS, STEPS } from "./maps.js";
import { fragment, VERTEX } from "./shader.js";

const VIEWS = ["colour", "luminance", "error", "difference"];
const TONES = ["srgb", "linear", "filmic"];

// Milliseconds that a part of a picture may take to draw, and how many there are at most.
const PART = 20;
const MOST_PARTS = 12;

export function withGl(canvas) {
  const gl = canvas.getContext("webgl2", { alpha: true, antialias: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => location.reload());
  gl.bindVertexArray(gl.createVertexArray());

  // Programs by what they draw. `use` tells where a uniform of one is.
  const programs = new Map();
  function linked(what) {
    const program = gl.createProgram(), places = {};
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment(what)]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    const at = (name) => (places[name] ??= gl.getUniformLocation(program, name));
    ["rgbA", "seA", "rgbB", "seB", "maps"].forEach((name, i) => gl.uniform1i(at(name), i));
    return { program, at };
  }
  function use(what) {
    const key = Object.values(what).join();
    if (!programs.has(key)) programs.set(key, linked(what));
    const { program, at } = programs.get(key);
    gl.useProgram(program);
    return at;
  }
  // What most pictures and their coarse passes are drawn by is not waited for.
  for (const shrunk of [true, false]) use({ view: 0, tone: 0, sides: 0, shrunk });

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

  // Of each picture its radiance, and its error once that is looked at.
  const held = new Map();
  function planes(picture, withError) {
    const { width, height, rgb, se, hasError } = picture;
    if (!held.has(picture)) {
      if (width > most || height > most) throw new Error(`a side of more than ${most} pixels is too long for this browser`);
      held.set(picture, [plane(width, height, rgb), nothing]);
    }
    const textures = held.get(picture);
    if (withError && hasError && textures[1] === nothing) textures[1] = plane(width, height, se);
    return textures;
  }

  // Of whole pictures that take long a few rows at a time are drawn, into this, and shown when all are there.
  const aside = { framebuffer: gl.createFramebuffer(), rows: gl.createTexture(), width: 0, height: 0 };
  function drawAside(width, height) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, aside.framebuffer);
    if (aside.width === width && aside.height === height) return;
    Object.assign(aside, { width, height });
    gl.bindTexture(gl.TEXTURE_2D, aside.rows);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, aside.rows, 0);
  }

  function prepare(state, { x, y, zoom }, ratio) {
    const { a, other } = state;
    const sides = other ? (state.flipped ? 2 : 1) : 0;
    const shrunk = [a, other].some((each) => each && zoom * ratio * each.step < 1);
    const at = use({ view: VIEWS.indexOf(state.view), tone: TONES.indexOf(state.tone), sides, shrunk });
    const withError = ["error", "difference"].includes(state.view);
    const textures = [a, other].flatMap((each) => (each ? planes(each, withError) : [nothing, nothing]));
    [...textures, maps].forEach((each, i) => {
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
    gl.uniform4f(at("surround"), 0.06, 0.06, 0.06, 0.12);
    gl.uniform4f(at("scales"), ...LUMINANCE, ...ERROR);
    gl.uniform2f(at("spread"), SIGMAS, SHARE);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  // Drawing goes on after it was asked for: `then` is called when it is done, so that pictures do not
  // queue up before an edit's first.
  function finished(then) {
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      const over = gl.isContextLost() || gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED;
      if (!over) return setTimeout(look, 2);
      gl.deleteSync(fence);
      then();
    };
    setTimeout(look);
  }

  // In how many parts a whole picture is drawn: what the last one took decides.
  let parts = MOST_PARTS;

  return {
    forget(kept) {
      for (const [picture, textures] of held) {
        if (kept.includes(picture)) continue;
        textures.filter((each) => each !== nothing).forEach((each) => gl.deleteTexture(each));
        held.delete(picture);
      }
    },
    finished,
    draw(state, pan, ratio) {
      prepare(state, pan, ratio);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    },
    // The same a part at a time, between which the graphics are free for what is more urgent. Nothing is
    // seen of it before the end, when `shown` is called; the function that is given back gives it up.
    drawInParts(state, pan, ratio, shown) {
      const { width, height } = canvas, n = parts, began = performance.now();
      let isWanted = true;
      drawAside(width, height);
      prepare(state, pan, ratio);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      const part = (i) => {
        if (!isWanted) return;
        gl.bindFramebuffer(gl.FRAMEBUFFER, aside.framebuffer);
        if (i < n) {
          const [from, to] = [i, i + 1].map((k) => Math.round((height * k) / n));
          gl.enable(gl.SCISSOR_TEST);
          gl.scissor(0, from, width, to - from);
          gl.drawArrays(gl.TRIANGLES, 0, 3);
          gl.disable(gl.SCISSOR_TEST);
        } else {
          gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
          gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        if (i < n) return finished(() => part(i + 1));
        parts = Math.min(Math.max(Math.ceil((performance.now() - began) / PART), 1), MOST_PARTS);
        shown();
      };
      part(0);
      return () => { isWanted = false; };
    },
  };
}
