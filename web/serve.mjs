#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// WebGPU under test by the native command, which has the oracles:
//
//   surefill certify --command "node web/serve.mjs --swiftshader"
//
// Options: those of dawn.mjs. Needs npm's package webgpu: npm install --prefix build/web-tools --ignore-scripts webgpu@0.6.2
import { parseArgs } from "node:util";
import { Conversation } from "./conversation.mjs";
import { dawn, kDawnOptions } from "./dawn.mjs";
import { kClose } from "./wire.mjs";

// Requests on stdin, answers on stdout: docs/adapters.md.
async function serve(open) {
  const conversation = new Conversation(open);
  let rest = Buffer.alloc(0);
  for await (const part of process.stdin) {
    rest = Buffer.concat([rest, part]);
    while (rest.length >= 8 && rest.length >= 8 + 4 * rest.readUInt32LE(4)) {
      const kind = rest.readUInt32LE(0), count = rest.readUInt32LE(4);
      const words = new Uint32Array(count);
      new Uint8Array(words.buffer).set(rest.subarray(8, 8 + 4 * count));
      rest = rest.subarray(8 + 4 * count);
      const answer = await conversation.ask(kind, words, 0, 0);
      const message = new Uint32Array(2 + answer.words.length);
      message.set([answer.status, answer.words.length]);
      message.set(answer.words, 2);
      await new Promise((done) => process.stdout.write(new Uint8Array(message.buffer), done));
      if (kind === kClose) return;
    }
  }
}

try {
  const { values } = parseArgs({ options: kDawnOptions });
  await serve(await dawn(values));
  process.exit(0);  // Dawn would keep the process alive
} catch (error) {
  console.error(`serve.mjs: ${error.message}`);
  process.exit(2);
}
