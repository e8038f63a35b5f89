#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// The page's certificate of a rasterizer and the command's, of one level and seed, say the same: check by check, finding by finding,
// scene by scene. The page's expected side is the engine, the command's the oracle.
//
//   node web/tests/same_test.mjs COMMAND.json PAGE.json
import { readFile } from "node:fs/promises";

const [command, page] = await Promise.all(process.argv.slice(2).map(async (file) => JSON.parse(await readFile(file, "utf8"))));
// Not in the page (web/wasm/meshes.cpp).
const kOnlyCommand = new Set(["partition-delaunay", "partition-adjacent", "grid-partition", "grid-degree", "degree-hull", "degree-spot"]);
const kSame = ["rule", "claim", "cases", "done", "skipped", "failed", "samples", "open", "differences", "largest_errors", "finding", "case",
  "shown", "scene_text", "evidence"];
// A mesh is as large as the rasterizer is fast, and whether it still tiles when snapped is a matter of its size.
const kTimed = { tilings: ["samples", "skipped"] };

const differences = [];
const compare = (what, a, b) => {
  if (JSON.stringify(a) !== JSON.stringify(b)) differences.push(`${what}: ${JSON.stringify(a)} by the command, ${JSON.stringify(b)} in the page`);
};
const checks = new Map(page.checks.map((check) => [check.name, check]));
let compared = 0;
for (const check of command.checks) {
  const other = checks.get(check.name);
  if (!other) {
    compare(check.name, kOnlyCommand.has(check.name) ? "left out" : "there", "left out");
    continue;
  }
  ++compared;
  for (const name of kSame) {
    if (!kTimed[check.name]?.includes(name)) compare(`${check.name}, ${name}`, check[name], other[name]);
  }
}
// Who it is, browser and Dawn say in their own words.
const said = ({ name, version, ...rest }) => rest;
compare("rival", said(command.rival), said(page.rival));
for (const name of ["format", "format_version", "verdict", "verdicts", "level", "seed", "means", "limits"]) compare(name, command[name], page[name]);
compare("checks of the page alone", [], page.checks.map((check) => check.name).filter((name) => !command.checks.some((check) => check.name === name)));
differences.forEach((text) => console.log(`FAIL  ${text.slice(0, 400)}`));
if (differences.length === 0) console.log(`ok    command and page say the same of ${command.rival.name}: ${compared} checks, verdict ${page.verdict}`);
process.exit(differences.length || compared === 0 ? 1 : 0);
