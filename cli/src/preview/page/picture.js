// A picture as it comes over the wire: see `frame.rs`.

const HALF = new Float32Array(65536);
for (let i = 0; i < 65536; i++) {
  const e = (i >> 10) & 31, m = i & 1023;
  const v = e === 31 ? (m ? NaN : Infinity) : e ? 2 ** (e - 15) * (1 + m / 1024) : 2 ** -24 * m;
  HALF[i] = i >> 15 ? -v : v;
}

// Rec. 709 weights of linear sRGB.
export const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

let made = 0;

export class Picture {
  constructor(buffer) {
    this.serial = made++;
    const view = new DataView(buffer);
    if (view.getUint32(0, true) !== 0x314c584c) throw new Error("not a picture of this program");
    const length = view.getUint32(4, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
    Object.assign(this, head);
    [this.width, this.height] = head.pixels;
    const area = this.width * this.height;
    let at = 8 + length;
    for (const plane of head.planes) {
      const n = plane === "n" ? area : area * 3;
      this[plane] = plane === "n" ? new Uint32Array(buffer, at, n) : new Uint16Array(buffer, at, n);
      at += this[plane].byteLength;
    }
    this.counted = head.planes.includes("n") ? (i) => this.n[i] : () => head.n;
    this.hasError = head.planes.includes("se");
  }

  // The index of the pixel of the whole picture at (x, y); -1 outside the window.
  index(x, y) {
    const [wx, wy, w, h] = this.window;
    if (!(x >= wx && y >= wy && x < wx + w && y < wy + h)) return -1;
    return Math.floor((y - wy) / this.step) * this.width + Math.floor((x - wx) / this.step);
  }

  three(plane, i) {
    return [0, 1, 2].map((c) => HALF[plane[i * 3 + c]] * this.unit);
  }

  radiance(i) { return this.three(this.rgb, i); }
  error(i) { return this.hasError ? this.three(this.se, i) : null; }
  samplesOf(i) { return this.counted(i); }

  // At most `most` pixels, evenly spread, as luminances of one pixel's sample.
  *spread(most) {
    const area = this.width * this.height;
    // An odd step does not run down columns.
    const step = Math.max(1, Math.floor(area / most)) | 1;
    for (let i = 0; i < area; i += step) yield this.radiance(i);
  }
}
