// SPDX-License-Identifier: Apache-2.0
// An exact rasterizer as small as they come: edge functions in BigInt, top-left rule.

// A float32, by its bits, times 2^149: a whole number. Nothing, if it is not finite.
export function whole(bits) {
  const exponent = (bits >>> 23) & 255;
  const fraction = BigInt(bits & 0x7fffff);
  if (exponent === 255) return undefined;
  const size = exponent === 0 ? fraction : (fraction + 0x800000n) << BigInt(exponent - 1);
  return bits >>> 31 ? -size : size;
}

// Calls cover(x, y) for each pixel of [x0, x1) x [y0, y1) whose centre the triangle covers. A vertex is {x, y, w}.
export function rasterize(v, [x0, y0, x1, y1], cover, fault) {
  const e = [0, 1, 2].map(i => {
    const p = v[(i + 1) % 3], q = v[(i + 2) % 3];
    return {a: p.y * q.w - p.w * q.y, b: p.w * q.x - p.x * q.w, c: p.x * q.y - p.y * q.x};
  });
  const d = v[0].x * e[0].a + v[0].y * e[0].b + v[0].w * e[0].c;
  if (d === 0n) return;
  if (fault && v.some(p => p.w < 0n)) return;  // a triangle with a vertex behind the eye is dropped
  for (let y = y0; y < y1; ++y) {
    for (let x = x0; x < x1; ++x) {
      const px = BigInt(2 * x + 1), py = BigInt(2 * y + 1);
      const inside = e.every(({a, b, c}) => {
        const side = a * px + b * py + 2n * c || a || b;
        return side > 0n === d > 0n;
      });
      if (inside) cover(x, y);
    }
  }
}
