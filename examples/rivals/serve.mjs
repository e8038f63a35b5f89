// SPDX-License-Identifier: Apache-2.0
//
// Puts a rasterizer in JavaScript under `surefill certify`: serve(draw, about) answers its requests over stdin and stdout, with
// Node alone. three_software.mjs is an example; docs/adapters.md has the messages.
//
//   draw(scene)  scene: {width, height, outputs, draws}, outputs being the names of those asked for, and each draw {positions,
//                triangles, identifiers}: 4 floats a vertex (X, Y, Z, W; seen at (X/W, Y/W), y down, depth Z/W), 3 numbers a
//                triangle, 1 a triangle. Returns an object of those outputs: count and index as Uint32Array, depth as
//                Float32Array, width * height of each. EMPTY in index, and Infinity in depth, is where nothing is.
//   about        {name, version, outputs: ["count", "index", "depth"]}
//
// A thrown Unsupported declines a scene and is never a finding; anything else that is thrown is one.
import { readSync, writeSync } from "node:fs";

export const EMPTY = 0xffffffff;
export class Unsupported extends Error {}

const OUTPUTS = ["count", "index", "depth"];
const [OPEN, DRAW, CLOSE] = [1, 2, 3];
const [OK, UNSUPPORTED, FAILED] = [0, 1, 2];
const DRAW_WORDS = 26; // the header of a draw
const OPENGL = 3; // the profile: values may be off by as much as OpenGL grants

// That many bytes, or null at the end.
function read(bytes) {
  const buffer = Buffer.alloc(bytes);
  for (let at = 0; at < bytes; ) {
    const got = readSync(0, buffer, at, bytes - at);
    if (got === 0) return null;
    at += got;
  }
  return buffer;
}

function write(buffer) {
  for (let at = 0; at < buffer.length; ) at += writeSync(1, buffer, at);
}

function reply(status, bytes) {
  const header = Buffer.alloc(8);
  header.writeUInt32LE(status, 0);
  header.writeUInt32LE(bytes.length / 4, 4);
  write(Buffer.concat([header, bytes]));
}

function words(text) {
  const bytes = Buffer.from(text).subarray(0, 1000);
  return Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)]);
}

// Names and 18 words: outputs, features (none), form (pixel), the model (unknown) of 9 words, of which the seventh is the profile,
// and 6 limits (none).
function describe({ name, version, outputs }) {
  const info = Buffer.alloc(128 + 18 * 4);
  info.write(name.slice(0, 63), 0);
  info.write(String(version ?? "").slice(0, 63), 64);
  info.writeUInt32LE(outputs.reduce((bits, output) => bits | (1 << OUTPUTS.indexOf(output)), 0), 128);
  info.writeUInt32LE(OPENGL, 128 + 4 * 9);
  return info;
}

function sceneOf(body) {
  const number = new Float32Array(body.buffer, body.byteOffset, body.length / 4);
  const word = new Uint32Array(body.buffer, body.byteOffset, body.length / 4);
  const scene = { width: word[1], height: word[2], outputs: OUTPUTS.filter((_, bit) => (word[0] >> bit) & 1), draws: [] };
  // No attribute and no initial depth come, since none was claimed.
  for (let at = 9, d = 0; d < word[7]; ++d) {
    const [vertices, triangles] = [word[at], word[at + 1]];
    const positions = at + DRAW_WORDS;
    const corners = positions + 8 * vertices; // clip space comes between
    const identifiers = corners + 3 * triangles;
    at = identifiers + triangles;
    scene.draws.push({
      positions: number.subarray(positions, positions + 4 * vertices),
      triangles: word.subarray(corners, identifiers),
      identifiers: word.subarray(identifiers, at),
    });
  }
  return scene;
}

export function serve(draw, about) {
  console.log = console.error; // stdout is for answers alone
  for (let header; (header = read(8)) !== null && header.readUInt32LE(0) !== CLOSE; ) {
    const body = read(4 * header.readUInt32LE(4));
    if (header.readUInt32LE(0) === OPEN) {
      reply(OK, describe(about));
      continue;
    }
    try {
      const scene = sceneOf(new Uint8Array(body));
      const images = draw(scene);
      reply(OK, Buffer.concat(scene.outputs.map((name) => Buffer.from(images[name].buffer, images[name].byteOffset, images[name].byteLength))));
    } catch (error) {
      if (!(error instanceof Unsupported)) console.error(error.stack);
      reply(error instanceof Unsupported ? UNSUPPORTED : FAILED, words(error.message));
    }
  }
}
