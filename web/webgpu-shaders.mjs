// SPDX-License-Identifier: Apache-2.0
//
// The WGSL of web/webgpu.mjs.
import { Interpolations } from "./wire.mjs";

const kFrame = `
struct Frame { width: u32, samples: u32, stride: u32, moved: f32 };
@group(0) @binding(0) var<uniform> frame: Frame;
fn pixel_of(position: vec4f) -> u32 { return u32(position.y) * frame.width + u32(position.x); }
`;

// What a driver could do wrong, planted into the shaders for the tests: it is found and named, or the tests fail.
const kWrongVertex = {
  "sample-moved": "out.position.x += frame.moved * v.position.w;",
};
const kWrongNumber = {
  "index-of-neighbour": "select(v.number, v.number + 1u, v.number % 2u == 1u)",
};
const kWrongCount = {
  "count-odd-columns": "select(1u, 2u, u32(position.x) % 8u == 7u)",
};
const kWrongDepth = {
  "depth-squared": "position.z * position.z",
};
export const kWrongShaders = [kWrongVertex, kWrongNumber, kWrongCount, kWrongDepth].flatMap(Object.keys);

function vertex(interpolations, centroid, barycentrics, wrong) {
  const place = centroid ? ", centroid" : "";
  const how = (interpolation) => interpolation === Interpolations.flat ? "flat"
    : interpolation === Interpolations.noperspective ? `linear${place}` : `perspective${place}`;
  const inputs = interpolations.map((_, k) => `@location(${2 + k}) value${k}: vec4f,`).join("\n  ");
  const outputs = interpolations.map((kind, k) => `@location(${2 + k}) @interpolate(${how(kind)}) value${k}: vec4f,`).join("\n  ");
  return `${kFrame}
struct Vertex {
  @location(0) position: vec4f,
  @location(1) number_and_corner: vec2u,
  ${inputs}
};
struct Varying {
  @builtin(position) position: vec4f,
  @location(0) @interpolate(flat) number: u32,
  ${barycentrics ? `@location(1) @interpolate(perspective${place}) weights: vec3f,` : ""}
  ${outputs}
};
@vertex fn vertex(v: Vertex) -> Varying {
  var out: Varying;
  out.position = v.position;
  ${kWrongVertex[wrong] ?? ""}
  out.number = v.number_and_corner.x;
  ${barycentrics ? "out.weights = vec3f(vec3u(0u, 1u, 2u) == vec3u(v.number_and_corner.y));" : ""}
  ${interpolations.map((_, k) => `out.value${k} = v.value${k};`).join("\n  ")}
  return out;
}
`;
}

// Each covered sample, whatever its depth.
export function countShader(wrong) {
  return `${vertex([], false, false, wrong)}
@group(0) @binding(1) var<storage, read_write> counts: array<atomic<u32>>;
@fragment fn fragment(@builtin(position) position: vec4f, @builtin(sample_mask) mask: u32) -> @location(0) vec4f {
  for (var n = 0u; n < frame.samples; n++) {
    if (frame.samples == 1u || ((mask >> n) & 1u) != 0u) {
      atomicAdd(&counts[pixel_of(position) * frame.samples + n], ${kWrongCount[wrong] ?? "1u"});
    }
  }
  return vec4f();
}
`;
}

// The number of the visible triangle; with several samples in two halves of 16 bits, since 32 bits can't be multisampled.
export function visibleShader(samples, wrong) {
  const number = kWrongNumber[wrong] ?? "v.number";
  const depth = kWrongDepth[wrong];
  const output = samples > 1 ? "vec2u(number & 0xFFFFu, number >> 16u)" : "number";
  const type = samples > 1 ? "vec2u" : "u32";
  return `${vertex([], false, false, wrong)}
struct Seen { @location(0) number: ${type}, ${depth ? "@builtin(frag_depth) depth: f32," : ""} };
@fragment fn fragment(v: Varying) -> Seen {
  let number = ${number};
  let position = v.position;
  var seen: Seen;
  seen.number = ${output};
  ${depth ? `seen.depth = ${depth};` : ""}
  return seen;
}
`;
}

// Both textures, sample by sample, into buffers.
export function readShader(samples) {
  const [numbers, depths] = samples > 1 ? ["texture_multisampled_2d<u32>", "texture_depth_multisampled_2d"]
    : ["texture_2d<u32>", "texture_depth_2d"];
  const number = samples > 1 ? "texel.x | (texel.y << 16u)" : "texel.x";
  return `${kFrame}
@group(0) @binding(1) var numbers: ${numbers};
@group(0) @binding(2) var depths: ${depths};
@group(0) @binding(3) var<storage, read_write> number_out: array<u32>;
@group(0) @binding(4) var<storage, read_write> depth_out: array<f32>;
@compute @workgroup_size(8, 8) fn read(@builtin(global_invocation_id) at: vec3u) {
  let size = textureDimensions(numbers);
  if (at.x >= size.x || at.y >= size.y) { return; }
  for (var n = 0u; n < frame.samples; n++) {
    let s = (at.y * frame.width + at.x) * frame.samples + n;
    let texel = textureLoad(numbers, at.xy, ${samples > 1 ? "n" : "0u"});
    number_out[s] = ${number};
    depth_out[s] = textureLoad(depths, at.xy, ${samples > 1 ? "n" : "0u"});
  }
}
`;
}

// Weights and attributes of the triangle that is visible at a sample, which the pass before found out.
export function valuesShader(interpolations, components, centroid, barycentrics, wrong) {
  let at = barycentrics ? 3 : 0;
  const stores = barycentrics ? [0, 1, 2].map((i) => `values[at + ${i}u] = v.weights[${i}];`) : [];
  components.forEach((count, k) => {
    for (let c = 0; c < count; ++c) stores.push(`values[at + ${at++}u] = v.value${k}[${c}];`);
  });
  return `${vertex(interpolations, centroid, barycentrics, wrong)}
@group(0) @binding(1) var<storage, read> seen: array<u32>;
@group(0) @binding(2) var<storage, read_write> values: array<f32>;
@fragment fn fragment(v: Varying, @builtin(sample_mask) mask: u32) -> @location(0) vec4f {
  for (var n = 0u; n < frame.samples; n++) {
    let s = pixel_of(v.position) * frame.samples + n;
    if ((frame.samples == 1u || ((mask >> n) & 1u) != 0u) && seen[s] == v.number) {
      let at = s * frame.stride;
      ${stores.join("\n      ")}
    }
  }
  return vec4f();
}
`;
}
