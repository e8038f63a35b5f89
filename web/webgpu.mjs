// SPDX-License-Identifier: Apache-2.0
//
// WebGPU as a rasterizer under test: off screen, in a browser or under Node (Dawn). A scene takes up to three passes: counts, by
// atomics in a storage buffer; the visible triangle and its depth, into textures that a compute shader reads sample by sample;
// weights and attributes, which the fragments of the visible triangles store.
import { DepthModes, Features, Outputs, Profiles, Unsupported } from "./wire.mjs";
import { depthsWithinBuffer, imageOf, kMaxAttributes, refuseOthers, scissorOf, vertexStream } from "./vertices.mjs";
import { countShader, kWrongShaders, readShader, valuesShader, visibleShader } from "./webgpu-shaders.mjs";

// States that the adapter would set wrongly, for the tests: the self-check has to notice.
export const kWrongStates = ["viewport", "scissor", "cull", "front-face", "depth-range", "depth-test", "flipped-y"];
// A device that does not last: lost with every so many scenes.
const kLostDevice = "lost-device", kLastsFor = 300;

const kUsage = { mapRead: 1, copySource: 4, copyTarget: 8, vertex: 32, uniform: 64, storage: 128 };
const kTexture = { copySource: 1, sampled: 4, attachment: 16 };
const kLongestWait = 16;  // milliseconds between two looks at a map
const kColours = { 1: "r32uint", 4: "rg16uint" };

export async function openWebGPU({ gpu = globalThis.navigator?.gpu, powerPreference, wrong = "" } = {}) {
  if (!gpu) throw new Unsupported("this browser has no WebGPU (or it is off)");
  const adapter = await gpu.requestAdapter(powerPreference ? { powerPreference } : {});
  if (!adapter) throw new Unsupported("WebGPU offers no adapter here");
  const features = ["depth-clip-control"].filter((feature) => adapter.features.has(feature));
  const wanted = ["maxTextureDimension2D", "maxStorageBufferBindingSize", "maxBufferSize"];
  const device = await adapter.requestDevice({
    requiredFeatures: features,
    requiredLimits: Object.fromEntries(wanted.map((limit) => [limit, adapter.limits[limit]])),
  });
  if (wrong && ![...kWrongStates, ...kWrongShaders, kLostDevice].includes(wrong)) throw new Unsupported(`no such fault: ${wrong}`);
  return new WebGPUAdapter(device, adapter.info ?? {}, features, wrong);
}

class WebGPUAdapter {
  constructor(device, info, features, wrong) {
    this.device = device;
    this.wrong = wrong;
    this.wrongShader = "";  // from trust() on
    this.lastsFor = wrong === kLostDevice ? kLastsFor : Infinity;
    this.isLost = false;
    this.clipControl = features.includes("depth-clip-control");
    this.cache = new Map();
    this.lost = device.lost.then((reason) => {
      this.isLost = true;
      throw new Error(`the device was lost: ${reason.message || reason.reason || "no reason given"}`);
    });
    this.lost.catch(() => {});
    const names = [info.vendor, info.architecture, info.device].filter(Boolean);
    this.info = {
      name: `WebGPU on ${names.join(" ") || "an unnamed adapter"}`,
      version: info.description || (info.isFallbackAdapter ? "fallback adapter" : "") || "unknown",
      outputs: Outputs.count | Outputs.index | Outputs.depth | Outputs.barycentrics | Outputs.attributes,
      features: Features.behind | Features.draws | Features.samples | Features.cull | Features.scissor | Features.depthClip |
        (this.clipControl ? Features.depthClamp : 0) | Features.depthGreater | Features.identifiers | Features.noperspective |
        Features.flat | Features.centroid,
      profile: Profiles.vulkan,
      maxSize: device.limits.maxTextureDimension2D,
      maxAttributes: kMaxAttributes,
      samples: [1, 4],
    };
  }

  // The self-check has passed: from here on planted faults of the driver's kind show.
  trust() {
    if (kWrongShaders.includes(this.wrong)) this.wrongShader = this.wrong;
  }

  close() {
    this.device.destroy();
  }

  cached(key, make) {
    if (!this.cache.has(key)) this.cache.set(key, make());
    return this.cache.get(key);
  }

  buffer(size, usage, data) {
    const bytes = Math.max(16, Math.ceil(size / 4) * 4);
    const buffer = this.device.createBuffer({ size: bytes, usage, mappedAtCreation: data !== undefined });
    if (data !== undefined) {
      new Uint32Array(buffer.getMappedRange()).set(data);
      buffer.unmap();
    }
    this.used.push(buffer);
    return buffer;
  }

  texture(scene, format) {
    const texture = this.device.createTexture({
      size: [scene.width, scene.height], sampleCount: scene.samples, format, usage: kTexture.attachment | kTexture.sampled,
    });
    this.used.push(texture);
    return texture.createView();
  }

  pipeline(pass, scene, draw) {
    const { shader, key, attributes, target, depth } = pass;
    const cull = this.wrong === "cull" ? "front" : ["none", "front", "back"][draw.cull];
    const clockwise = (draw.frontFace === 0) !== (this.wrong === "front-face");
    const unclipped = this.clipControl && draw.depthMode !== DepthModes.clip;
    const compare = this.wrong === "depth-test" ? "always" : scene.greater ? "greater-equal" : "less-equal";
    return this.cached([key, scene.samples, cull, clockwise, unclipped, compare].join(), () => {
      const module = this.cached(`module ${key}`, () => this.device.createShaderModule({ code: shader() }));
      const formats = [["float32x4", 0], ["uint32x2", 16]];
      for (let k = 0; k < attributes; ++k) formats.push(["float32x4", 24 + 16 * k]);
      return this.device.createRenderPipeline({
        layout: "auto",
        vertex: {
          module,
          buffers: [{
            arrayStride: 24 + 16 * attributes,
            attributes: formats.map(([format, offset], shaderLocation) => ({ format, offset, shaderLocation })),
          }],
        },
        fragment: { module, targets: [target] },
        primitive: { topology: "triangle-list", frontFace: clockwise ? "cw" : "ccw", cullMode: cull, unclippedDepth: unclipped },
        multisample: { count: scene.samples },
        ...(depth && { depthStencil: { format: "depth32float", depthWriteEnabled: true, depthCompare: compare } }),
      });
    });
  }

  // Draws the whole frame in one pass.
  drawPass(encoder, scene, stream, pass, colour, depth, buffers) {
    const view = encoder.beginRenderPass({
      colorAttachments: [{ view: colour, loadOp: "clear", storeOp: pass.depth ? "store" : "discard", clearValue: [0, 0, 0, 0] }],
      ...(depth && {
        depthStencilAttachment: { view: depth, depthLoadOp: "clear", depthStoreOp: "store", depthClearValue: scene.greater ? 0 : 1 },
      }),
    });
    for (const { draw, first, count } of stream.batches) {
      const [x, y, width, height] = scissorOf(scene, draw);
      if (width === 0 || height === 0 || count === 0) continue;
      const pipeline = this.pipeline(pass, scene, draw);
      view.setPipeline(pipeline);
      const entries = buffers.map((buffer, binding) => ({ binding, resource: { buffer } }));
      view.setBindGroup(0, this.device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
      const port = draw.viewport, half = this.wrong === "viewport" ? 0.5 : 1;
      const [near, far] = this.wrong === "depth-range" ? [0, 0.5] : [port.near, port.far];
      view.setViewport(port.x, port.y, port.width * half, port.height, near, far);
      view.setScissorRect(x, y, this.wrong === "scissor" ? Math.min(width, 4) : width, height);
      view.setVertexBuffer(0, stream.buffer);
      view.draw(count, 1, first);
    }
    view.end();
  }

  async draw(scene) {
    refuseOthers(scene);
    if (!this.info.samples.includes(scene.samples)) throw new Unsupported(`${scene.samples} samples a pixel`);
    const asked = (output) => (scene.outputs & output) !== 0;
    const visible = asked(Outputs.index | Outputs.depth | Outputs.barycentrics | Outputs.attributes);
    if (visible && !depthsWithinBuffer(scene)) throw new Unsupported("depths outside 0 to 1, which a depth buffer does not hold");
    if (scene.draws.some((draw) => draw.depthMode === DepthModes.clamp) && !this.clipControl) throw new Unsupported("depth clamping");
    this.used = [];
    if (--this.lastsFor < 0) this.device.destroy();
    this.device.pushErrorScope("validation");
    this.device.pushErrorScope("out-of-memory");
    try {
      const image = await Promise.race([this.drawn(scene, visible, asked), this.lost]);
      const errors = await Promise.race([Promise.all([this.device.popErrorScope(), this.device.popErrorScope()]), this.lost]);
      const error = errors.find(Boolean);
      if (error) throw new Error(`WebGPU says: ${error.message.split("\n")[0]}`);
      return image;
    } finally {
      for (const resource of this.used) resource.destroy();
    }
  }

  async drawn(scene, visible, asked) {
    const { device } = this;
    const total = scene.width * scene.height * scene.samples;
    const barycentrics = asked(Outputs.barycentrics), attributes = asked(Outputs.attributes);
    const components = attributes ? scene.components : [];
    const stride = (barycentrics ? 3 : 0) + components.reduce((sum, count) => sum + count, 0);
    const encoder = device.createCommandEncoder();
    const outputs = [];  // buffers of the answer and their sizes in words
    const storage = kUsage.storage | kUsage.copySource;
    const frameBuffer = (port) => {
      const words = new Uint32Array([scene.width, scene.samples, stride, 0]);
      new Float32Array(words.buffer)[3] = 2 / 16 / port;
      return this.buffer(16, kUsage.uniform, words);
    };
    const frame = frameBuffer(scene.draws[0]?.viewport.width ?? 1);
    const stream = (options) => {
      const made = vertexStream(scene, { firstVertexFlat: false, ...options });
      if (this.wrong === "flipped-y") {
        const floats = new Float32Array(made.words.buffer);
        for (let at = 1; at < floats.length; at += made.stride) floats[at] = -floats[at];
      }
      return { ...made, buffer: this.buffer(4 * made.words.length, kUsage.vertex, made.words) };
    };
    const wrong = this.wrongShader;
    const nothing = { format: "r8unorm", writeMask: 0 };
    let counts = -1, seen = -1, values = -1, identifiers;
    if (asked(Outputs.count)) {
      const buffer = this.buffer(4 * total, storage);
      const pass = { key: "count" + wrong, shader: () => countShader(wrong), attributes: 0, target: nothing };
      this.drawPass(encoder, scene, stream({ flatZ: !this.clipControl }), pass, this.texture(scene, "r8unorm"), null, [frame, buffer]);
      counts = outputs.push([buffer, total]) - 1;
    }
    if (visible) {
      const format = kColours[scene.samples];
      const colour = this.texture(scene, format), depth = this.texture(scene, "depth32float");
      const plain = stream({});
      identifiers = plain.identifiers;
      const pass = {
        key: `visible ${scene.samples}` + wrong, shader: () => visibleShader(scene.samples, wrong), attributes: 0, target: { format }, depth: true,
      };
      // A frame is bound where the shader reads it.
      this.drawPass(encoder, scene, plain, pass, colour, depth, wrong === "sample-moved" ? [frame] : []);
      const numbers = this.buffer(4 * total, storage), depths = this.buffer(4 * total, storage);
      const read = this.cached(`read ${scene.samples}`, () => device.createComputePipeline({
        layout: "auto", compute: { module: device.createShaderModule({ code: readShader(scene.samples) }) },
      }));
      const compute = encoder.beginComputePass();
      compute.setPipeline(read);
      compute.setBindGroup(0, device.createBindGroup({
        layout: read.getBindGroupLayout(0),
        entries: [{ buffer: frame }, colour, depth, { buffer: numbers }, { buffer: depths }].map((resource, binding) => ({ binding, resource })),
      }));
      compute.dispatchWorkgroups(Math.ceil(scene.width / 8), Math.ceil(scene.height / 8));
      compute.end();
      seen = outputs.push([numbers, total], [depths, total]) - 2;
      if (stride > 0) {
        const interpolations = attributes ? (scene.draws[0]?.attributes ?? []).map((_, k) => k) : [];
        const buffer = this.buffer(4 * total * stride, storage);
        const withValues = stream({ attributes });
        this.drawValues(encoder, scene, withValues, interpolations, components, barycentrics, [frame, numbers, buffer]);
        values = outputs.push([buffer, total * stride]) - 1;
      }
    }
    const answers = await this.readBack(encoder, outputs);
    return imageOf(scene, { asked, total, stride, components, identifiers, counts: answers[counts], numbers: answers[seen],
      depths: answers[seen + 1], values: answers[values] });
  }

  // Draws may differ in their interpolation: a pass for each kind, all onto the same buffer.
  drawValues(encoder, scene, stream, attributes, components, barycentrics, buffers) {
    const kinds = new Map();
    for (const batch of stream.batches) {
      const interpolations = attributes.map((k) => batch.draw.attributes[k].interpolation);
      const key = interpolations.join();
      if (!kinds.has(key)) kinds.set(key, { interpolations, batches: [] });
      kinds.get(key).batches.push(batch);
    }
    const centroid = scene.centroid && scene.samples > 1, wrong = this.wrongShader;
    for (const [key, { interpolations, batches }] of kinds) {
      const pass = {
        key: `values ${key} ${components} ${centroid} ${barycentrics}` + wrong,
        shader: () => valuesShader(interpolations, components, centroid, barycentrics, wrong),
        attributes: interpolations.length,
        target: { format: "r8unorm", writeMask: 0 },
      };
      this.drawPass(encoder, scene, { ...stream, batches }, pass, this.texture(scene, "r8unorm"), null, buffers);
    }
  }

  // Firefox looks whether a map is there ten times a second, and with each submission: an empty one is what hastens it.
  async arrival(mapped) {
    let waits = true;
    const done = mapped.finally(() => (waits = false));
    for (let milliseconds = 1; waits && !this.isLost; milliseconds = Math.min(2 * milliseconds, kLongestWait)) {
      this.device.queue.submit([]);
      let timer;
      await Promise.race([done, new Promise((next) => (timer = setTimeout(next, milliseconds)))]);
      clearTimeout(timer);
    }
    await done;
  }

  async readBack(encoder, outputs) {
    const words = outputs.reduce((sum, [, count]) => sum + count, 0);
    const staging = this.buffer(4 * words, kUsage.mapRead | kUsage.copyTarget);
    let at = 0;
    for (const [buffer, count] of outputs) {
      encoder.copyBufferToBuffer(buffer, 0, staging, 4 * at, 4 * count);
      at += count;
    }
    this.device.queue.submit([encoder.finish()]);
    await this.arrival(staging.mapAsync(1));
    const all = new Uint32Array(staging.getMappedRange().slice(0));
    staging.unmap();
    at = 0;
    return outputs.map(([, count]) => all.subarray(at, (at += count)));
  }
}
