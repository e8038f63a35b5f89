// SPDX-License-Identifier: Apache-2.0
//
// WebGPU without a browser: Dawn, by npm's package webgpu.
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { openWebGPU } from "./webgpu.mjs";

export const kSwiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json";  // of Debian's chromium-common
const root = fileURLToPath(new URL("..", import.meta.url));

export const kDawnOptions = {
  power: { type: "string" },         // low-power or high-performance
  wrong: { type: "string", default: "" },  // a planted fault, for tests
  swiftshader: { type: "boolean" },  // Chromium's software driver
  tools: { type: "string", default: join(root, "build/web-tools") },  // the folder of node_modules
};

// What opens an adapter.
export async function dawn({ power, wrong, swiftshader, tools }) {
  if (swiftshader) process.env.VK_ICD_FILENAMES = kSwiftShader;
  const { create, globals } = await import(pathToFileURL(createRequire(join(tools, "/")).resolve("webgpu")));
  Object.assign(globalThis, globals);
  const gpu = create([]);
  return () => openWebGPU({ gpu, powerPreference: power, wrong });
}
