// SPDX-License-Identifier: Apache-2.0
//
// The adapter's messages (docs/adapters.md, version 1) as typed arrays: scenes in, images out.

export const kOpen = 1, kDraw = 2, kClose = 3;
export const kOk = 0, kUnsupported = 1, kFailed = 2;
export const kEmpty = 0xffffffff;

export const Outputs = { count: 1, index: 2, depth: 4, barycentrics: 8, attributes: 16 };
export const Features = {
  behind: 1 << 0, draws: 1 << 1, samples: 1 << 2, cull: 1 << 3, scissor: 1 << 4, depthClip: 1 << 5, depthClamp: 1 << 6,
  depthGreater: 1 << 7, depthReadOnly: 1 << 8, initialDepth: 1 << 9, identifiers: 1 << 10, noperspective: 1 << 11, flat: 1 << 12,
  centroid: 1 << 13,
};
export const Profiles = { exact: 0, d3d11: 1, vulkan: 2, opengl: 3 };
export const DepthModes = { any: 0, clip: 1, clamp: 2 };
export const Interpolations = { perspective: 0, noperspective: 1, flat: 2 };

// The scene is not for this adapter: no finding.
export class Unsupported extends Error {}

// Takes arrays off the front of a message.
class Reader {
  constructor(words) {
    this.words = words;
    this.at = 0;
  }
  take(count) {
    if (this.at + count > this.words.length) throw new Error("a scene that ends too early");
    this.at += count;
    return this.words.subarray(this.at - count, this.at);
  }
  floats(count) {
    const part = this.take(count);
    return new Float32Array(part.buffer, part.byteOffset, count);
  }
  word() {
    return this.take(1)[0];
  }
}

export function decodeScene(words) {
  const reader = new Reader(words);
  const [outputs, width, height, samples, depthTest, location, attributeCount, drawCount, hasDepth] = reader.take(9);
  const components = [...reader.take(attributeCount)];
  const initialDepth = hasDepth ? reader.floats(width * height * samples) : null;
  const draws = [];
  for (let d = 0; d < drawCount; ++d) {
    const [vertexCount, triangleCount, clipIsExact] = reader.take(3);
    const [x, y, viewWidth, viewHeight, near, far] = reader.floats(6);
    const [, , frontFace, cull, depthMode, depthWrite, conservative, hasScissor] = reader.take(8);
    const scissor = [...reader.take(4)].map((word) => word | 0);
    reader.take(5);  // a grid, which is not claimed
    const pixel = reader.floats(4 * vertexCount), clip = reader.floats(4 * vertexCount);
    const indices = reader.take(3 * triangleCount), identifiers = reader.take(triangleCount);
    const attributes = components.map((count) => ({
      components: count,
      interpolation: reader.word(),
      values: reader.floats(count * vertexCount),
    }));
    draws.push({
      vertexCount, triangleCount, clipIsExact: clipIsExact !== 0, viewport: { x, y, width: viewWidth, height: viewHeight, near, far },
      frontFace, cull, depthMode, depthWrite: depthWrite !== 0, conservative, scissor: hasScissor ? scissor : null, pixel, clip, indices,
      identifiers, attributes,
    });
  }
  return { outputs, width, height, samples, greater: depthTest === 1, centroid: location === 1, components, initialDepth, draws };
}

export function textWords(text) {
  const bytes = new TextEncoder().encode(text);
  const words = new Uint32Array(Math.ceil(bytes.length / 4));
  new Uint8Array(words.buffer).set(bytes);
  return words;
}

// What an adapter says of itself: { name, version, outputs, features, profile, rows up, depth from -1, limits }.
export function infoWords(info) {
  const words = new Uint32Array(32 + 18);
  const bytes = new Uint8Array(words.buffer);
  const text = (place, value) => bytes.set(new TextEncoder().encode(value).subarray(0, 63), place);
  text(0, info.name);
  text(64, info.version);
  words.set([info.outputs, info.features, 1], 32);  // the form: clip space
  words.set([0, info.subpixelBits ?? 0, 0, 0, 0, 0, info.profile, info.rowsUp ? 1 : 0, info.depthFromMinusOne ? 1 : 0], 35);
  words.set([info.maxSize, info.maxSize, 0, 0, info.maxAttributes, 4], 44);
  return words;
}

// The outputs that were asked for, in the order of their bits.
export function imageWords(scene, image) {
  const samples = scene.width * scene.height * scene.samples;
  const parts = [];
  const add = (values, count) => {
    if (values.length !== count) throw new Error(`an output of ${values.length} words where ${count} are due`);
    parts.push(new Uint32Array(values.buffer, values.byteOffset, count));
  };
  if (scene.outputs & Outputs.count) add(image.count, samples);
  if (scene.outputs & Outputs.index) add(image.index, samples);
  if (scene.outputs & Outputs.depth) add(image.depth, samples);
  if (scene.outputs & Outputs.barycentrics) add(image.barycentrics, 3 * samples);
  if (scene.outputs & Outputs.attributes) scene.components.forEach((count, k) => add(image.attributes[k], count * samples));
  const words = new Uint32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    words.set(part, at);
    at += part.length;
  }
  return words;
}
