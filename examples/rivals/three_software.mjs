// SPDX-License-Identifier: Apache-2.0
//
// The SoftwareRenderer that three.js had until release 108, under test: colours that say which triangle it is, on a canvas that
// is no more than an array. It cuts what is wider than 100 pixels into four, over and over and outside of the image, too; what would
// take it seconds is declined.
//   npm install --prefix build/rivals three@0.106.2
//   surefill certify --command "node examples/rivals/three_software.mjs"
import { createRequire } from "node:module";

import { EMPTY, Unsupported, serve } from "./serve.mjs";

console.log = console.error;
const require = createRequire(new URL("../../build/rivals/", import.meta.url));
const THREE = (globalThis.THREE = require("three"));
require("three/examples/js/renderers/Projector.js");
require("three/examples/js/renderers/SoftwareRenderer.js");

const BLOCK = 8; // its canvas is cut to a multiple of this
const WIDEST = 1 << 14; // pixels

let pixels;
const canvas = {
  getContext: () => ({
    getImageData(x, y, width, height) {
      pixels = new Uint8ClampedArray(4 * width * height);
      return { data: pixels, width, height };
    },
    putImageData() {},
    fillRect() {},
  }),
};
const renderer = new THREE.SoftwareRenderer({ canvas });
const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, vertexColors: THREE.FaceColors });

function draw({ width, height, draws }) {
  const [wide, high] = [width, height].map((side) => Math.ceil(side / BLOCK) * BLOCK);
  renderer.setSize(wide, high);
  const geometry = new THREE.Geometry();
  const identifiers = [];
  for (const { positions, triangles, identifiers: names } of draws) {
    for (let t = 0; 3 * t < triangles.length; ++t) {
      const first = geometry.vertices.length;
      for (const i of triangles.subarray(3 * t, 3 * t + 3)) {
        const [x, y, z, w] = positions.subarray(4 * i, 4 * i + 4);
        if (Math.max(Math.abs(x), Math.abs(y)) > WIDEST * w) throw new Unsupported("triangles far beside the image");
        geometry.vertices.push(new THREE.Vector3((2 * x) / w / wide - 1, 1 - (2 * y) / w / high, (2 * z) / w - 1));
      }
      identifiers.push(names[t]);
      const face = new THREE.Face3(first, first + 1, first + 2, new THREE.Vector3(0, 0, 1));
      face.color = new THREE.Color(identifiers.length); // 0 is the background
      geometry.faces.push(face);
    }
  }
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  const scene = new THREE.Scene();
  scene.add(mesh);
  renderer.render(scene, new THREE.Camera());
  const index = new Uint32Array(width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const at = 4 * (y * wide + x);
      const colour = (pixels[at] << 16) | (pixels[at + 1] << 8) | pixels[at + 2];
      index[y * width + x] = colour === 0 ? EMPTY : identifiers[colour - 1];
    }
  }
  return { index };
}

serve(draw, { name: "three.js SoftwareRenderer", version: THREE.REVISION, outputs: ["index"] });
