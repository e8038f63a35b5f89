// SPDX-License-Identifier: Apache-2.0
//
// What WebGPU and WebGL2 have in common: the vertices of a scene in the order in which they are drawn, which scenes a depth buffer can
// show, and the image of what was read back.
import { DepthModes, Outputs, Unsupported, kEmpty } from "./wire.mjs";

export const kMaxAttributes = 4;

// Three vertices a triangle, none shared, so that all three carry the triangle's number: position in clip space (4 floats), number,
// corner, 4 floats an attribute. Numbers are 1, 2, ... over the frame; identifiers[number] is what the index image shows.
//
// The whole frame goes from its last triangle to its first, those of a draw by identifier: with the test LESS_OR_EQUAL the visible
// triangle is then the first of equal ones (V1, V3), and a fragment at the depth that the buffer was cleared to is seen.
//
// flatZ: draws of depth mode any get depth 1/2, where only counts are wanted and depth clipping cannot be switched off.
// firstVertexFlat: all three vertices get the flat values of vertex 0.
export function vertexStream(scene, { attributes, flatZ, firstVertexFlat }) {
  const count = attributes ? scene.components.length : 0;
  const stride = 6 + 4 * count;
  const triangles = scene.draws.reduce((sum, draw) => sum + draw.triangleCount, 0);
  const words = new Uint32Array(3 * triangles * stride), floats = new Float32Array(words.buffer);
  const identifiers = new Uint32Array(triangles + 1);
  const batches = [];
  let at = 0, number = 0;
  for (const draw of [...scene.draws].reverse()) {
    const order = Array.from({ length: draw.triangleCount }, (_, t) => t);
    order.sort((a, b) => draw.identifiers[b] - draw.identifiers[a] || b - a);
    batches.push({ draw, first: at / stride, count: 3 * draw.triangleCount });
    const flat = flatZ && draw.depthMode === DepthModes.any;
    for (const t of order) {
      identifiers[++number] = draw.identifiers[t];
      for (let corner = 0; corner < 3; ++corner) {
        const v = draw.indices[3 * t + corner];
        floats.set(draw.clip.subarray(4 * v, 4 * v + 4), at);
        if (flat) floats[at + 2] = draw.clip[4 * v + 3] / 2;
        words[at + 4] = number;
        words[at + 5] = corner;
        for (let k = 0; k < count; ++k) {
          const attribute = draw.attributes[k], n = attribute.components;
          const from = attribute.interpolation === 2 && firstVertexFlat ? draw.indices[3 * t] : v;
          floats.set(attribute.values.subarray(n * from, n * from + n), at + 6 + 4 * k);
        }
        at += stride;
      }
    }
  }
  return { words, stride, batches, identifiers };
}

// A depth buffer holds 0 to 1. Where depth is not clipped and not clamped, depths outside would come out clamped: such scenes have
// coverage alone. True where no depth can be outside.
export function depthsWithinBuffer(scene) {
  for (const draw of scene.draws) {
    if (draw.depthMode !== DepthModes.any) continue;
    for (let t = 0; t < draw.triangleCount; ++t) {
      const z = [], w = [];
      for (let i = 0; i < 3; ++i) {
        const v = draw.indices[3 * t + i];
        z.push(draw.pixel[4 * v + 2]);
        w.push(draw.pixel[4 * v + 3]);
      }
      const within = [0, 1, 2].every((i) => z[i] >= 0 && z[i] <= w[i]);
      // Or one depth z = c w, 0 <= c <= 1, all over the triangle. Products of two float32 are exact in double.
      const constant = [0, 1, 2].every((i) => {
        const j = (i + 1) % 3;
        return z[i] * w[j] === z[j] * w[i] && w[i] !== 0 && z[i] * w[i] >= 0 && z[i] * z[i] <= w[i] * w[i];
      });
      if (!within && !constant) return false;
    }
  }
  return true;
}

// What no adapter of the page draws.
export function refuseOthers(scene) {
  if (scene.initialDepth) throw new Unsupported("initial depth");
  if (scene.components.length > kMaxAttributes) throw new Unsupported("this number of attributes");
  for (const draw of scene.draws) {
    if (draw.conservative) throw new Unsupported("conservative rasterization");
    if (!draw.depthWrite) throw new Unsupported("depth write off");
  }
}

// The part of the target that the scissor leaves: x, y, width, height.
export function scissorOf(scene, draw) {
  const [x0, y0, x1, y1] = draw.scissor ?? [0, 0, scene.width, scene.height];
  const clamp = (value, most) => Math.min(Math.max(value, 0), most);
  const x = clamp(x0, scene.width), y = clamp(y0, scene.height);
  return [x, y, Math.max(clamp(x1, scene.width) - x, 0), Math.max(clamp(y1, scene.height) - y, 0)];
}

// The outputs that were asked for, as the adapter has them: what nothing covers holds its values of empty samples.
export function imageOf(scene, { asked, total, stride, components, identifiers, counts, numbers, depths, values }) {
  const image = {};
  if (asked(Outputs.count)) image.count = counts;
  if (asked(Outputs.index)) image.index = numbers.map((number) => (number === 0 ? kEmpty : identifiers[number] ?? number));
  if (asked(Outputs.depth)) {
    const all = new Float32Array(depths.buffer, depths.byteOffset, total), none = scene.greater ? -Infinity : Infinity;
    image.depth = all.map((depth, s) => (numbers[s] === 0 ? none : depth));
  }
  const floats = values && new Float32Array(values.buffer, values.byteOffset, total * stride);
  const part = (at, count) => {
    const result = new Float32Array(total * count);
    for (let s = 0; s < total; ++s) {
      if (numbers[s] === 0) continue;
      for (let c = 0; c < count; ++c) result[s * count + c] = floats[s * stride + at + c];
    }
    return result;
  };
  let at = 0;
  if (asked(Outputs.barycentrics)) {
    image.barycentrics = part(0, 3);
    at = 3;
  }
  if (asked(Outputs.attributes)) {
    image.attributes = components.map((count) => {
      at += count;
      return part(at - count, count);
    });
  }
  return image;
}
