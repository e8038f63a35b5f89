// SPDX-License-Identifier: Apache-2.0
//
// Before anybody is judged: scenes whose edges pass every sample at a distance that any GPU keeps, in each state that the adapter
// sets. What does not come out, the adapter has set wrongly, or something else has.
import { Features, Outputs, kEmpty } from "./wire.mjs";

const kSize = 16;
const kNear = 2 ** -8;  // no verdict on precision: a state that is wrong is off by far more

// Edges keep 1/16 pixel and more from every standard sample, and corners are multiples of that, the least precision that there is.
const kScene = [
  { corners: [[-20.3125, -20.3125], [60.3125, -20.3125], [-20.3125, 60.3125]], depth: 0.75, identifier: 5 },
  { corners: [[2.3125, 3.3125], [11.3125, 3.3125], [2.3125, 12.3125]], depth: 0.25, identifier: 7 },
  { corners: [[13.3125, 6.3125], [5.3125, 14.3125], [13.3125, 14.3125]], depth: 0.5, identifier: 9 },
];
const kPlaces = { 1: [[8, 8]], 4: [[6, 2], [14, 6], [2, 10], [10, 14]] };

const edge = (a, b, p) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);

// 1: covered and clockwise on the screen; -1: covered, the other way round; 0: not covered.
function cover({ corners: c }, p) {
  const signs = [edge(c[1], c[2], p), edge(c[2], c[0], p), edge(c[0], c[1], p)].map(Math.sign);
  return signs.every((s) => s > 0) ? 1 : signs.every((s) => s < 0) ? -1 : 0;
}

function sceneOf(adapter, change) {
  const n = 3 * kScene.length, fromMinusOne = adapter.info.depthFromMinusOne;
  const draw = {
    vertexCount: n, triangleCount: kScene.length, clipIsExact: true,
    viewport: { x: 0, y: 0, width: kSize, height: kSize, near: 0, far: 1 },
    frontFace: 0, cull: 0, depthMode: 0, depthWrite: true, conservative: 0, scissor: null,
    pixel: new Float32Array(4 * n), clip: new Float32Array(4 * n), indices: Uint32Array.from({ length: n }, (_, i) => i),
    identifiers: Uint32Array.from(kScene, (triangle) => triangle.identifier),
    attributes: [0, 1, 2].map((interpolation) => ({ components: 2, interpolation, values: new Float32Array(2 * n) })),
  };
  kScene.forEach(({ corners, depth }, t) => corners.forEach(([x, y], corner) => {
    const v = 3 * t + corner;
    draw.pixel.set([x, y, depth, 1], 4 * v);
    draw.clip.set([x / (kSize / 2) - 1, 1 - y / (kSize / 2), fromMinusOne ? 2 * depth - 1 : depth, 1], 4 * v);
    for (const attribute of draw.attributes) attribute.values.set([4 * corner, 3], 2 * v);
  }));
  const scene = {
    outputs: adapter.info.outputs, width: kSize, height: kSize, samples: 1, greater: false, centroid: false, components: [2, 2, 2],
    initialDepth: null, draws: [draw],
  };
  change(scene, draw);
  return scene;
}

async function check(adapter, what, change) {
  const scene = sceneOf(adapter, change), draw = scene.draws[0];
  const image = await adapter.draw(scene);
  const asked = (output) => (scene.outputs & output) !== 0;
  const differs = (output, x, y, expected, actual) =>
    `${what}: ${output} at pixel (${x}, ${y}) is ${actual === kEmpty ? "none" : actual} instead of ` +
    `${expected === kEmpty ? "none" : expected}; some state is not what the adapter needs`;
  const shows = (triangle, p, x, y) => {
    const side = cover(triangle, p);
    if (side === 0) return false;
    const front = (side > 0) === (draw.frontFace === 0);
    if (draw.cull === (front ? 1 : 2)) return false;
    const s = draw.scissor;
    return !s || (x >= s[0] && y >= s[1] && x < s[2] && y < s[3]);
  };
  for (let y = 0; y < kSize; ++y) {
    for (let x = 0; x < kSize; ++x) {
      for (let n = 0; n < scene.samples; ++n) {
        const row = adapter.info.rowsUp ? kSize - 1 - y : y;
        const s = (row * kSize + x) * scene.samples + n;
        const place = kPlaces[scene.samples][n], p = [x + place[0] / 16, y + place[1] / 16];
        const covers = kScene.filter((triangle) => shows(triangle, p, x, y));
        const seen = covers.reduce((best, triangle) =>
          !best || (scene.greater ? triangle.depth > best.depth : triangle.depth < best.depth) ? triangle : best, null);
        if (asked(Outputs.count) && image.count[s] !== covers.length) return differs("count", x, y, covers.length, image.count[s]);
        const wanted = seen ? seen.identifier : kEmpty;
        if (asked(Outputs.index) && image.index[s] !== wanted) return differs("index", x, y, wanted, image.index[s]);
        const none = scene.greater ? -Infinity : Infinity;
        if (asked(Outputs.depth) && !(seen ? Math.abs(image.depth[s] - seen.depth) <= kNear : image.depth[s] === none)) {
          return differs("depth", x, y, seen ? seen.depth : none, image.depth[s]);
        }
        if (!seen || scene.samples > 1) continue;
        const c = seen.corners, area = edge(c[0], c[1], c[2]);
        const weights = [edge(c[1], c[2], p), edge(c[2], c[0], p), edge(c[0], c[1], p)].map((e) => e / area);
        for (let i = 0; asked(Outputs.barycentrics) && i < 3; ++i) {
          const found = image.barycentrics[3 * s + i];
          if (!(Math.abs(found - weights[i]) <= kNear)) return differs("barycentrics", x, y, weights[i], found);
        }
        // The attribute is 4 i at vertex i: perspective, affine (W is 1 everywhere), that of vertex 0.
        const smooth = 4 * weights[1] + 8 * weights[2];
        for (let k = 0; asked(Outputs.attributes) && k < scene.components.length; ++k) {
          const due = draw.attributes[k].interpolation === 2 ? 0 : smooth;
          const [first, second] = image.attributes[k].subarray(2 * s, 2 * s + 2);
          if (!(Math.abs(first - due) <= 8 * kNear)) return differs("attribute", x, y, due, first);
          if (!(Math.abs(second - 3) <= kNear)) return differs("attribute", x, y, 3, second);
        }
      }
    }
  }
  return "";
}

// What is wrong, as a sentence; empty if nothing.
export async function selfCheck(adapter) {
  const has = (feature) => (adapter.info.features & feature) !== 0;
  const checks = [
    ["a plain scene", () => {}],
    ["culled back faces", (scene, draw) => (draw.cull = 2)],
    ["culled front faces", (scene, draw) => ((draw.cull = 1), (draw.frontFace = 1))],
    ["a scissor", (scene, draw) => (draw.scissor = [3, 2, 12, 9])],
    ["depth test greater", (scene) => (scene.greater = true)],
    ["depth clipping", (scene, draw) => (draw.depthMode = 1)],
  ];
  if (has(Features.samples)) checks.push(["4 samples a pixel", (scene) => (scene.samples = 4)]);
  for (const [what, change] of checks) {
    // What is not claimed is not asked for.
    const known = (scene, draw) => {
      change(scene, draw);
      if (!has(Features.noperspective)) draw.attributes[1].interpolation = 0;
    };
    const problem = await check(adapter, what, known);
    if (problem) return problem;
  }
  return "";
}
