#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// What the page does, without a browser: WebGPU by Dawn, judged by the page's judge.
//
//   node web/certify.mjs [--swiftshader] [--level quick] [--seed 1] [--checks NAMES] [--json FILE] [--html FILE] [--scene FILE]
//
// Needs build/web (`./dev web`). Exit status: 0 certified, 1 not, 2 neither.
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { fileURLToPath } from "node:url";
import { Conversation } from "./conversation.mjs";
import { dawn, kDawnOptions } from "./dawn.mjs";
import { Judge } from "./judge.mjs";
import { unpackLzma } from "./lzma.mjs";

const { values } = parseArgs({
  options: {
    ...kDawnOptions,
    level: { type: "string", default: "quick" },
    seed: { type: "string", default: "1" },
    checks: { type: "string", default: "" },
    json: { type: "string" },
    html: { type: "string" },
    scene: { type: "string" },  // judges this one alone
    folder: { type: "string", default: fileURLToPath(new URL("../build/web", import.meta.url)) },
  },
});
try {
  const file = async (name) => unpackLzma(await readFile(join(values.folder, name)));
  const conversation = new Conversation(await dawn(values));
  const judge = await Judge.open(await file("judge.wasm.lzma"), {
    ask: (...request) => conversation.ask(...request),
    tell: (what, text) => {
      if (what === "line" || what === "verdict") process.stdout.write(text);
      if (what === "unopened" || what === "error") console.error(text);
    },
  });
  judge.addCorpus(new TextDecoder().decode(await file("corpus.txt.lzma")));
  const start = performance.now();
  const told = values.scene
    ? await judge.judgeScene({ scene: await readFile(values.scene, "utf8") })
    : await judge.certify({ ...values, machine: `Node ${process.version}, Dawn` });
  const seconds = (performance.now() - start) / 1000, waited = conversation.waited / 1000;
  console.log(`${seconds.toFixed(1)} s, of which the rasterizer ${waited.toFixed(1)} s for ${conversation.drawn} scenes`);
  if (values.json && told.certificate) await writeFile(values.json, told.certificate);
  if (values.html && told.report) await writeFile(values.html, told.report);
  const verdict = told.certificate ? JSON.parse(told.certificate).verdict : told.verdict ? (JSON.parse(told.verdict).differences ? "not" : "certified") : "";
  process.exit(verdict === "certified" ? 0 : verdict ? 1 : 2);
} catch (error) {
  console.error(`certify.mjs: ${error.stack}`);
  process.exit(2);
}
