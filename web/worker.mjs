// SPDX-License-Identifier: Apache-2.0
//
// Judge and adapter, off the page's thread. Messages in: { run: options } (page.mjs), { stop: true }. Out: { progress: [check, checks,
// share] }, { told: [what, text] } (judge.mjs), and at the end { done: { seconds, waited, drawn, bytes } } or { failed: text }.
import { Conversation } from "./conversation.mjs";
import { Judge } from "./judge.mjs";
import { unpackLzma } from "./lzma.mjs";
import { openWebGL2 } from "./webgl2.mjs";
import { openWebGPU } from "./webgpu.mjs";

const kAdapters = { webgpu: openWebGPU, webgl2: openWebGL2 };
let judge = null, stopped = false, bytes = 0;

async function file(name) {
  const response = await fetch(new URL(name, import.meta.url));
  if (!response.ok) throw new Error(`${name} did not come: ${response.status} ${response.statusText}`);
  const content = new Uint8Array(await response.arrayBuffer());
  bytes += content.length;
  return unpackLzma(content);
}

async function run(options) {
  bytes = 0;
  const open = kAdapters[options.api];
  if (!open) throw new Error(`no such interface: ${options.api}`);
  const conversation = new Conversation(() => open({ powerPreference: options.power || undefined, wrong: options.wrong }));
  judge = await Judge.open(await file("judge.wasm.lzma"), {
    ask: (...request) => conversation.ask(...request),
    tell: (...told) => postMessage({ told }),
    progress: (...progress) => postMessage({ progress }),
  });
  const corpus = judge.addCorpus(new TextDecoder().decode(await file("corpus.txt.lzma")));
  if (stopped) judge.stop();
  const start = performance.now();
  if (options.scene) {
    // The name of a case of the corpus is as good as its text.
    const scene = corpus.get(`corpus/cases/${options.scene.trim()}.scene`) ?? options.scene;
    postMessage({ told: ["scene", scene] });
    await judge.judgeScene({ ...options, scene });
  } else {
    await judge.certify({ ...options, machine: navigator.userAgent });
  }
  conversation.close();
  postMessage({ done: { seconds: (performance.now() - start) / 1000, waited: conversation.waited / 1000, drawn: conversation.drawn, bytes } });
}

onmessage = async ({ data }) => {
  if (data.stop) {
    stopped = true;
    judge?.stop();
    return;
  }
  try {
    await run(data.run);
  } catch (error) {
    postMessage({ failed: String(error.stack ?? error) });
  }
};
