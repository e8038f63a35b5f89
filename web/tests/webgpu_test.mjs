#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// The adapter of WebGPU on Chromium's software driver: its self-check passes, and notices each state that is set wrongly.
//
//   node web/tests/webgpu_test.mjs [--tools FOLDER]
import { parseArgs } from "node:util";
import { dawn, kDawnOptions } from "../dawn.mjs";
import { selfCheck } from "../selfcheck.mjs";
import { kWrongStates } from "../webgpu.mjs";

const { values } = parseArgs({ options: kDawnOptions });
let failures = 0;
for (const wrong of ["", ...kWrongStates]) {
  const open = await dawn({ ...values, swiftshader: true, wrong });
  const adapter = await open();
  const problem = await selfCheck(adapter);
  adapter.close();
  const holds = (problem === "") === (wrong === "");
  console.log(`${holds ? "ok  " : "FAIL"}  ${wrong || "no fault"}: ${problem || "the self-check passes"}`);
  if (!holds) ++failures;
}
process.exit(failures ? 1 : 0);
