// SPDX-License-Identifier: Apache-2.0
//
// WebGL2 as a rasterizer under test, off screen. Counts by additive blending of floats; the visible triangle and its depth in textures;
// weights and attributes, one after the other, of those fragments whose triangle is the visible one. One sample a pixel: nobody can read
// the samples of a pixel one by one here. Rows go up, and clip depth is from -1 to 1.
import { DepthModes, Features, Interpolations, Outputs, Profiles, Unsupported } from "./wire.mjs";
import { depthsWithinBuffer, imageOf, kMaxAttributes, refuseOthers, scissorOf, vertexStream } from "./vertices.mjs";

// States that the adapter would set wrongly, and faults of a driver's kind, for the tests (webgpu.mjs).
const kWrongStates = ["viewport", "scissor", "cull", "front-face", "depth-range", "depth-test", "flipped-y"];
const kWrongShaders = ["sample-moved"];
const kExtensions = ["EXT_color_buffer_float", "EXT_float_blend"];

const kHead = "#version 300 es\nprecision highp float; precision highp int; precision highp sampler2D; precision highp usampler2D;\n";
const vertexShader = (value, flat) => `${kHead}
layout(location = 0) in vec4 position;
layout(location = 1) in uvec2 numbers;
layout(location = 2) in vec4 given;
uniform float moved;
invariant gl_Position;
flat out uint number;
${flat ? "flat" : "smooth"} out vec4 value;
void main() {
  gl_Position = position + vec4(moved * position.w, 0.0, 0.0, 0.0);
  number = numbers.x;
  value = ${value};
}`;
const kCorner = "vec4(numbers.y == 0u, numbers.y == 1u, numbers.y == 2u, 0.0)";
const kNoValue = "vec4(0.0)";
const kCountShader = `${kHead}
flat in uint number;
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }`;
const kVisibleShader = `${kHead}
flat in uint number;
layout(location = 0) out uvec4 color;
void main() { color = uvec4(number); }`;
const valueShader = (flat) => `${kHead}
flat in uint number;
${flat ? "flat" : "smooth"} in vec4 value;
uniform usampler2D seen;
layout(location = 0) out vec4 color;
void main() {
  if (texelFetch(seen, ivec2(gl_FragCoord.xy), 0).r != number) discard;
  color = value;
}`;
// Numbers and depths of a whole target, as bits.
const kWholeShader = `${kHead}
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;
const kReadShader = `${kHead}
uniform usampler2D seen;
uniform sampler2D depths;
layout(location = 0) out uvec4 color;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  color = uvec4(texelFetch(seen, at, 0).r, floatBitsToUint(texelFetch(depths, at, 0).r), 0u, 0u);
}`;

// One of the four words of each pixel.
function component(words, which) {
  const part = new Uint32Array(words.length / 4);
  for (let s = 0; s < part.length; ++s) part[s] = words[4 * s + which];
  return part;
}

export async function openWebGL2({ powerPreference, wrong = "" } = {}) {
  if (typeof OffscreenCanvas === "undefined") throw new Unsupported("this browser has no WebGL2 off screen");
  const canvas = new OffscreenCanvas(1, 1);
  const gl = canvas.getContext("webgl2", { antialias: false, depth: false, powerPreference: powerPreference ?? "default" });
  if (!gl) throw new Unsupported("this browser has no WebGL2 (or it is off)");
  for (const name of kExtensions) if (!gl.getExtension(name)) throw new Unsupported(`WebGL2 without ${name}`);
  if (wrong && ![...kWrongStates, ...kWrongShaders].includes(wrong)) throw new Unsupported(`no such fault: ${wrong}`);
  return new WebGL2Adapter(gl, wrong);
}

class WebGL2Adapter {
  constructor(gl, wrong) {
    this.gl = gl;
    this.wrong = wrong;
    this.trusted = false;
    this.cache = new Map();
    const renderer = gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
    this.info = {
      name: `WebGL2 on ${renderer}`,
      version: gl.getParameter(gl.VERSION),
      outputs: Outputs.count | Outputs.index | Outputs.depth | Outputs.barycentrics | Outputs.attributes,
      features: Features.behind | Features.draws | Features.cull | Features.scissor | Features.depthClip | Features.depthGreater |
        Features.identifiers | Features.flat,
      profile: Profiles.opengl,
      rowsUp: true,
      depthFromMinusOne: true,
      subpixelBits: gl.getParameter(gl.SUBPIXEL_BITS),
      maxSize: Math.min(gl.getParameter(gl.MAX_TEXTURE_SIZE), ...gl.getParameter(gl.MAX_VIEWPORT_DIMS)),
      maxAttributes: kMaxAttributes,
    };
  }

  // The self-check has passed: from here on planted faults of the driver's kind show.
  trust() {
    this.trusted = true;
  }

  get isLost() {
    return this.gl.isContextLost();
  }

  close() {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }

  program(vertex, fragment) {
    const { gl } = this, key = vertex + fragment;
    if (!this.cache.has(key)) {
      const program = gl.createProgram();
      for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        gl.deleteShader(shader);
      }
      gl.linkProgram(program);
      if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
        throw new Error(`WebGL2 does not link a program: ${gl.getProgramInfoLog(program)}`);
      }
      this.cache.set(key, program);
    }
    gl.useProgram(this.cache.get(key));
    return this.cache.get(key);
  }

  texture(scene, format) {
    const { gl } = this, texture = gl.createTexture();
    this.used.push(() => gl.deleteTexture(texture));
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, scene.width, scene.height);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    return texture;
  }

  // The target of what follows, cleared.
  target(scene, format, depth) {
    const { gl } = this, colour = this.texture(scene, format), frame = gl.createFramebuffer();
    this.frame = frame;
    this.used.push(() => gl.deleteFramebuffer(frame));
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
    if (depth) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    for (const state of [gl.BLEND, gl.CULL_FACE, gl.DEPTH_TEST, gl.DITHER, gl.SCISSOR_TEST]) gl.disable(state);
    gl.viewport(0, 0, scene.width, scene.height);
    if (format === gl.RGBA32UI) gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    else gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    if (depth) {
      gl.depthMask(true);
      gl.clearBufferfv(gl.DEPTH, 0, [scene.greater ? 0 : 1]);
    }
    return colour;
  }

  bind(program, name, texture, unit) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.uniform1i(gl.getUniformLocation(program, name), unit);
  }

  vertices(scene, options) {
    const { gl } = this, stream = vertexStream(scene, { firstVertexFlat: true, ...options }), buffer = gl.createBuffer();
    this.used.push(() => gl.deleteBuffer(buffer));
    if (this.wrong === "flipped-y") {
      const floats = new Float32Array(stream.words.buffer);
      for (let at = 1; at < floats.length; at += stream.stride) floats[at] = -floats[at];
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, stream.words, gl.STREAM_DRAW);
    return { ...stream, buffer };
  }

  // The batches in the current target, with the current program. `attribute`: the one at location 2; -1: none.
  drawStream(scene, stream, program, attribute = -1) {
    const { gl, wrong } = this, bytes = 4 * stream.stride;
    gl.bindBuffer(gl.ARRAY_BUFFER, stream.buffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 4, gl.FLOAT, false, bytes, 0);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribIPointer(1, 2, gl.UNSIGNED_INT, bytes, 16);
    if (attribute < 0) {
      gl.disableVertexAttribArray(2);
    } else {
      gl.enableVertexAttribArray(2);
      gl.vertexAttribPointer(2, 4, gl.FLOAT, false, bytes, 24 + 16 * attribute);
    }
    gl.enable(gl.SCISSOR_TEST);
    for (const { draw, first, count } of stream.batches) {
      const [x, y, width, height] = scissorOf(scene, draw), port = draw.viewport;
      if (width === 0 || height === 0 || count === 0) continue;
      gl.scissor(x, scene.height - y - height, wrong === "scissor" ? Math.min(width, 4) : width, height);
      gl.viewport(port.x, scene.height - port.y - port.height, wrong === "viewport" ? port.width / 2 : port.width, port.height);
      if (wrong === "depth-range") gl.depthRange(0, 0.5);
      else gl.depthRange(port.near, port.far);
      gl.frontFace((draw.frontFace === 0) !== (wrong === "front-face") ? gl.CW : gl.CCW);
      const cull = wrong === "cull" ? 1 : draw.cull;
      if (cull) gl.enable(gl.CULL_FACE), gl.cullFace(cull === 1 ? gl.FRONT : gl.BACK);
      else gl.disable(gl.CULL_FACE);
      gl.uniform1f(gl.getUniformLocation(program, "moved"), this.trusted && wrong === "sample-moved" ? 2 / 16 / port.width : 0);
      gl.drawArrays(gl.TRIANGLES, first, count);
    }
  }

  // When the GPU has done it all: reading blocks, waiting does not.
  async finished() {
    const { gl } = this, fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const channel = new MessageChannel();
    while (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
      await new Promise((next) => {
        channel.port1.onmessage = next;
        channel.port2.postMessage(0);
      });
    }
    channel.port1.close();
    gl.deleteSync(fence);
  }

  // What was drawn last is to be read: `use` gets its words.
  read(Words, format, type, use) {
    this.readings.push({ frame: this.frame, Words, format, type, use });
  }

  // One wait for all of them: a browser takes milliseconds to hear that its GPU is done, and for each reading.
  async readAll(scene) {
    const { gl, readings } = this, count = 4 * scene.width * scene.height, buffer = gl.createBuffer();
    this.used.push(() => gl.deleteBuffer(buffer));
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, 4 * count * readings.length, gl.STREAM_READ);
    readings.forEach(({ frame, format, type }, k) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.readPixels(0, 0, scene.width, scene.height, format, type, 4 * count * k);
    });
    await this.finished();
    if (gl.isContextLost()) throw new Error("the context was lost");
    const all = new ArrayBuffer(4 * count * readings.length);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, new Uint8Array(all));
    readings.forEach(({ Words, use }, k) => use(new Words(all, 4 * count * k, count)));
  }

  async draw(scene) {
    refuseOthers(scene);
    if (scene.samples !== 1) throw new Unsupported(`${scene.samples} samples a pixel`);
    const asked = (output) => (scene.outputs & output) !== 0;
    const visible = asked(Outputs.index | Outputs.depth | Outputs.barycentrics | Outputs.attributes);
    if (visible && !depthsWithinBuffer(scene)) throw new Unsupported("depths outside 0 to 1, which a depth buffer does not hold");
    for (const draw of scene.draws) {
      const { x, y, width, height } = draw.viewport;
      if (![x, y, width, height].every(Number.isInteger)) throw new Unsupported("a viewport that is not of whole pixels");
      if (draw.depthMode === DepthModes.clamp) throw new Unsupported("depth clamping");
      if (asked(Outputs.attributes) && draw.attributes.some((attribute) => attribute.interpolation === Interpolations.noperspective)) {
        throw new Unsupported("noperspective attributes");
      }
    }
    this.used = [];
    this.readings = [];
    try {
      const image = await this.drawn(scene, visible, asked);
      const error = this.gl.getError();
      if (error !== this.gl.NO_ERROR) throw new Error(`WebGL2 says error ${error}`);
      return image;
    } finally {
      for (const free of this.used) free();
    }
  }

  async drawn(scene, visible, asked) {
    const { gl } = this, total = scene.width * scene.height, found = {};
    if (asked(Outputs.count)) {
      this.target(scene, gl.RGBA32F);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE);
      const program = this.program(vertexShader(kNoValue, true), kCountShader);
      this.drawStream(scene, this.vertices(scene, { flatZ: true }), program);
      this.read(Float32Array, gl.RGBA, gl.FLOAT, (counts) => (found.counts = component(counts, 0)));
    }
    if (visible) this.drawVisible(scene, asked, found);
    await this.readAll(scene);
    return imageOf(scene, { asked, total, components: scene.components, ...found });
  }

  drawVisible(scene, asked, found) {
    const { gl } = this;
    const depths = this.texture(scene, gl.DEPTH_COMPONENT32F);
    const seen = this.target(scene, gl.RGBA32UI, depths);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(this.wrong === "depth-test" ? gl.ALWAYS : scene.greater ? gl.GEQUAL : gl.LEQUAL);
    const stream = this.vertices(scene, { attributes: asked(Outputs.attributes) });
    this.drawStream(scene, stream, this.program(vertexShader(kNoValue, true), kVisibleShader));
    const reading = this.target(scene, gl.RGBA32UI) && this.program(kWholeShader, kReadShader);
    this.bind(reading, "seen", seen, 0);
    this.bind(reading, "depths", depths, 1);
    gl.disableVertexAttribArray(0), gl.disableVertexAttribArray(1), gl.disableVertexAttribArray(2);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.read(Uint32Array, gl.RGBA_INTEGER, gl.UNSIGNED_INT, (bits) => {
      found.numbers = component(bits, 0);
      found.depths = component(bits, 1);
    });
    found.identifiers = stream.identifiers;
    this.addValues(scene, stream, seen, asked, found);
  }

  // Barycentrics, then the attributes, sample by sample into found.values.
  addValues(scene, stream, seen, asked, found) {
    const { gl } = this, passes = [];
    if (asked(Outputs.barycentrics)) passes.push({ components: 3, attribute: -1, flat: false });
    if (asked(Outputs.attributes)) scene.components.forEach((components, attribute) => passes.push({ components, attribute }));
    found.stride = passes.reduce((sum, pass) => sum + pass.components, 0);
    const samples = scene.width * scene.height, values = new Float32Array(samples * found.stride);
    let next = 0;
    for (const { components, attribute } of passes) {
      this.target(scene, gl.RGBA32F);
      // Draws may differ in their interpolation.
      for (const flat of [false, true]) {
        const batches = stream.batches.filter(({ draw }) =>
          (attribute >= 0 && draw.attributes[attribute].interpolation === Interpolations.flat) === flat);
        if (batches.length === 0) continue;
        const program = this.program(vertexShader(attribute < 0 ? kCorner : "given", flat), valueShader(flat));
        this.bind(program, "seen", seen, 0);
        this.drawStream(scene, { ...stream, batches }, program, attribute);
      }
      const at = next;
      this.read(Float32Array, gl.RGBA, gl.FLOAT, (read) => {
        for (let s = 0; s < samples; ++s) {
          for (let c = 0; c < components; ++c) values[s * found.stride + at + c] = read[4 * s + c];
        }
      });
      next += components;
    }
    found.values = new Uint32Array(values.buffer);
  }
}
