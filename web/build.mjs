#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// usage: node web/build.mjs WASM FOLDER
// The page as a folder that any static host serves: the modules as they are, judge and corpus compressed (lzma.mjs), the corpus as one
// text. It says what a visitor loads; with a judge of more than kMostJudge bytes there is no page.
import { execFile } from "node:child_process";
import { cp, mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { gzipSync } from "node:zlib";
import { unpackLzma } from "./lzma.mjs";

const kPage = ["index.html", "style.css", "page.mjs", "worker.mjs", "judge.mjs", "lzma.mjs", "conversation.mjs", "selfcheck.mjs", "vertices.mjs", "wire.mjs",
  "webgl2.mjs", "webgpu.mjs", "webgpu-shaders.mjs"];
const kMostJudge = 400_000;
const [wasm, folder] = process.argv.slice(2);
const root = fileURLToPath(new URL("..", import.meta.url));

async function scenes(place) {
  const entries = await readdir(join(root, place), { withFileTypes: true });
  const parts = await Promise.all(entries.map((entry) => {
    const path = join(place, entry.name);
    return entry.isDirectory() ? scenes(path) : path.endsWith(".scene") ? [path] : [];
  }));
  return parts.flat().sort();
}

async function writeCompressed(name, bytes) {
  const path = join(folder, name);
  await writeFile(path, bytes);
  await promisify(execFile)("xz", ["--format=lzma", "--lzma1=preset=9e,lc=4,pb=0,mf=bt2", path]);
  const packed = await readFile(`${path}.lzma`);
  if (Buffer.compare(unpackLzma(packed), Buffer.from(bytes)) !== 0) throw new Error(`${name} does not come back as it was`);
  return packed.length;
}

await rm(folder, { recursive: true, force: true });
await mkdir(folder, { recursive: true });
let modules = 0;
for (const name of kPage) {
  await cp(join(root, "web", name), join(folder, name));
  modules += gzipSync(await readFile(join(root, "web", name)), { level: 9 }).length;
}
let corpus = "";
for (const path of await scenes("corpus/cases")) corpus += `=== ${relative(".", path)}\n${await readFile(join(root, path), "utf8")}`;
const judge = await writeCompressed("judge.wasm", await readFile(wasm)), texts = await writeCompressed("corpus.txt", corpus);
console.log(`bytes: judge ${judge}, corpus ${texts}, modules ${modules} by gzip, together ${judge + texts + modules}`);
if (judge > kMostJudge) {
  console.error(`build.mjs: the judge is larger than the ${kMostJudge} bytes that it may have`);
  process.exit(1);
}
