// SPDX-License-Identifier: Apache-2.0
//
// Runs a WebAssembly program under Node: node wasi.mjs PROGRAM.wasm ARGUMENTS... It sees all files, by absolute paths.
import { readFile } from "node:fs/promises";
import { WASI } from "node:wasi";

const [program, ...args] = process.argv.slice(2);
const wasi = new WASI({ version: "preview1", args: [program, ...args], preopens: { "/": "/" } });
const { instance } = await WebAssembly.instantiate(await readFile(program), { wasi_snapshot_preview1: wasi.wasiImport });
process.exitCode = wasi.start(instance);
