// Drawing without WebGL 2: the whole picture is shaded on the processor and then scaled.

import { shade } from "./shade.js";

export function flat(canvas) {
  const context = canvas.getContext("2d");
  let drawn = { key: "" };

  function shaded(state, picture, other) {
    const { width, height } = picture, image = new ImageData(width, height), scale = state.scaleOf();
    const [wx, wy] = picture.window;
    const pixel = (of, i) => [of.radiance(i), of.error(i)];
    for (let i = 0; i < width * height; i++) {
      const x = wx + (i % width) * picture.step, y = wy + Math.floor(i / width) * picture.step;
      const j = state.view === "difference" && other ? other.index(x, y) : -1;
      image.data.set(shade(state.view, state.tone, scale, pixel(picture, i), j < 0 ? null : pixel(other, j)), i * 4);
      image.data[i * 4 + 3] = 255;
    }
    const made = new OffscreenCanvas(width, height);
    made.getContext("2d").putImageData(image, 0, 0);
    return made;
  }

  return {
    forget() { drawn = { key: "" }; },
    finished(then) { then(); },
    draw(state, { x, y, zoom }, ratio) {
      const { a, other, view, tone, ev } = state;
      const key = [view, tone, ev, other?.name, state.compare].join();
      if (drawn.key !== key || drawn.a !== a || drawn.other !== other) {
        drawn = { key, a, other, images: [a, other].map((each) => each && shaded(state, each, other)) };
      }
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, canvas.width, canvas.height);
      context.imageSmoothingEnabled = zoom * ratio < 1;
      const put = (picture, image, from, to) => {
        const [wx, wy, w, h] = picture.window;
        context.save();
        context.beginPath();
        context.rect(from, 0, to - from, canvas.height);
        context.clip();
        context.setTransform(zoom * ratio, 0, 0, zoom * ratio, x * ratio, y * ratio);
        context.beginPath();
        context.rect(wx, wy, w, h);
        context.clip();
        context.drawImage(image, wx, wy, image.width * picture.step, image.height * picture.step);
        context.restore();
      };
      const split = !other || view === "difference" ? canvas.width : state.flipped ? 0 : state.wipe * canvas.width;
      put(a, drawn.images[0], 0, split);
      if (other) put(other, drawn.images[1], split, canvas.width);
    },
  };
}
