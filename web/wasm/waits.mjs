#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// usage: node web/wasm/waits.mjs MODULE.wat NEVER_WAITS
// Writes the functions of a module in which an indirect call may wait for the rasterizer (env.ask), a line each, for asyncify's
// add-list; direct calls asyncify follows itself. WebAssembly checks the type of a function that is called indirectly: so such a call
// may wait if a function of its type may that is in the table. NEVER_WAITS are names, with *, of functions that are known not to wait
// when they are called indirectly and whose own indirect calls do not.
import { readFileSync } from "node:fs";

const [module, never] = process.argv.slice(2).map((file) => readFileSync(file, "utf8").split("\n"));
const patterns = never.filter(Boolean).map((name) => new RegExp(`^${name.split("*").map((part) => part.replace(/[^\w ]/g, "\\$&")).join(".*")}$`, "s"));
const neverWaits = (name) => patterns.some((pattern) => pattern.test(name));

const kName = /\$(?:"((?:[^"\\]|\\.)*)"|([^\s()]+))/;
const nameIn = (text) => {
  const [, quoted, plain] = text.match(kName);
  return quoted?.replace(/\\(['"\\])/g, "$1") ?? plain;
};
// Parameters and results, without names of locals.
const typeIn = (text) => ["param", "result"].map((part) => [...text.matchAll(new RegExp(`\\(${part} (?:\\$\\S+ )?([^)]+)\\)`, "g"))].map((match) => match[1]).join(" ")).join(" > ");

const types = new Map(), functions = new Map(), inTable = [], waits = new Set();
let current = null;
for (const line of module) {
  const text = line.trim();
  if (text.startsWith("(type ")) {
    types.set(nameIn(text), typeIn(text));
  } else if (text.startsWith("(import ") && text.includes("(func ")) {
    const name = nameIn(text);
    functions.set(name, { type: typeIn(text), calls: new Set(), indirect: new Set() });
    if (text.startsWith('(import "env" "ask"')) waits.add(name);
  } else if (text.startsWith("(elem ")) {
    inTable.push(...[...text.matchAll(new RegExp(kName, "g"))].slice(1).map((match) => nameIn(match[0])));
  } else if (line.startsWith(" (func ")) {
    current = { type: typeIn(text), calls: new Set(), indirect: new Set() };
    functions.set(nameIn(text), current);
  } else if (/^\((return_)?call \$/.test(text)) {
    current.calls.add(nameIn(text));
  } else if (/^\((return_)?call_indirect /.test(text)) {
    current.indirect.add(types.get(nameIn(text.slice(text.indexOf("(type ")))));
  }
}
if (waits.size !== 1 || inTable.length === 0 || inTable.some((name) => !functions.has(name))) throw new Error("this is no module of the page's judge");

const waitingTypes = new Set(), listed = new Set();
for (let before = -1; before !== waits.size + waitingTypes.size;) {
  before = waits.size + waitingTypes.size;
  for (const name of inTable) if (waits.has(name) && !neverWaits(name)) waitingTypes.add(functions.get(name).type);
  for (const [name, { calls, indirect }] of functions) {
    const byTable = !neverWaits(name) && [...indirect].some((type) => waitingTypes.has(type));
    if (byTable) listed.add(name);
    if (byTable || [...calls].some((callee) => waits.has(callee))) waits.add(name);
  }
}
const wrong = [...waits].filter((name) => neverWaits(name) && !listed.has(name));
if (wrong.length > 0) throw new Error(`these are said never to wait, and call what may: ${wrong.join("; ")}`);
console.error(`${waits.size} of ${functions.size} functions may wait, ${listed.size} of them in an indirect call`);
console.log([...listed].join("\n"));
