// SPDX-License-Identifier: Apache-2.0
// Holds raster.mjs against vectors/coverage_exact.json: every test is right, or the fault is named.
// node run.mjs coverage_exact.json [--fault]
import {readFileSync} from 'node:fs';
import {rasterize, whole} from './raster.mjs';

const unroll = runs => runs.flatMap((run, i) => i % 2 === 0 ? Array(run).fill(runs[i + 1]) : []);

function counts(test, fault) {
  const {width, height} = test.target;
  const window = test.window ?? [0, 0, width, height];
  const [x0, y0, x1, y1] = window;
  const result = Array((x1 - x0) * (y1 - y0)).fill(0);
  for (const draw of test.frames[0].draws) {
    const vertices = draw.vertices.bits.map(vertex => vertex.map(bits => whole(parseInt(bits, 16))));
    for (const corners of draw.triangles) {
      const triangle = corners.map(k => vertices[k]);
      if (triangle.flat().includes(undefined)) continue;
      rasterize(triangle.map(([x, y, , w]) => ({x, y, w})), window, (x, y) => ++result[(y - y0) * (x1 - x0) + x - x0], fault);
    }
  }
  return result;
}

const [path, ...options] = process.argv.slice(2);
const {tests, notes} = JSON.parse(readFileSync(path, 'utf8'));
const failed = new Set();
for (const test of tests) {
  const expected = unroll(test.frames[0].expected.count);
  if (counts(test, options.includes('--fault')).some((count, s) => count !== expected[s])) failed.add(test.id);
}
console.log(`${tests.length} tests, ${failed.size} wrong`);

if (failed.size > 0) {
  const scores = Object.keys(notes).map(name => {
    const shown = tests.filter(test => test.kills.includes(name)).map(test => test.id);
    const both = shown.filter(id => failed.has(id)).length;
    return {name, score: both / (shown.length + failed.size - both)};
  });
  const {name} = scores.reduce((a, b) => b.score > a.score ? b : a);
  console.log(`likely: ${name}: ${notes[name].bug}`);
}
process.exit(failed.size > 0 ? 1 : 0);
