#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// usage: node web/build.mjs WASM FOLDER
// The page as a folder that any static host serves: the modules as they are, the judge compressed, the corpus as one text.
import { cp, mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const kPage = ["index.html", "style.css", "page.mjs", "worker.mjs", "judge.mjs", "conversation.mjs", "selfcheck.mjs", "vertices.mjs", "wire.mjs",
  "webgl2.mjs", "webgpu.mjs", "webgpu-shaders.mjs"];
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

const compressed = (bytes) => gzipSync(bytes, { level: 9 });
await rm(folder, { recursive: true, force: true });
await mkdir(folder, { recursive: true });
for (const name of kPage) await cp(join(root, "web", name), join(folder, name));
await writeFile(join(folder, "judge.wasm.gz"), compressed(await readFile(wasm)));
let corpus = "";
for (const path of await scenes("corpus/cases")) corpus += `=== ${relative(".", path)}\n${await readFile(join(root, path), "utf8")}`;
await writeFile(join(folder, "corpus.txt.gz"), compressed(corpus));
