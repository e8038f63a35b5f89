// SPDX-License-Identifier: Apache-2.0
//
// The judge's requests and what the adapter answers. Whatever becomes of it, an answer comes in time: an adapter that loses its
// device or takes too long is given up, which is a finding, and the next request opens a new one.
import { Unsupported, decodeScene, imageWords, infoWords, kDraw, kFailed, kOk, kOpen, kUnsupported, textWords } from "./wire.mjs";
import { selfCheck } from "./selfcheck.mjs";

const kOpeningSeconds = 60;
const answered = (status, words) => ({ outcome: 0, status, words });
const silent = (outcome, text) => ({ outcome, status: kFailed, words: textWords(text) });

class TooLate extends Error {}

function within(promise, seconds) {
  let timer;
  const limit = new Promise((_, reject) => (timer = setTimeout(() => reject(new TooLate()), 1000 * seconds)));
  return Promise.race([promise, limit]).finally(() => clearTimeout(timer));
}

export class Conversation {
  // `open` gives an adapter: { info, draw(scene), trust(), close() }. `seconds`: for one scene, at least.
  constructor(open, { seconds = 20 } = {}) {
    this.open = open;
    this.seconds = seconds;
    this.adapter = null;
    this.waited = 0;  // milliseconds in the adapter
    this.drawn = 0;   // scenes
  }

  async ask(kind, words, most, milliseconds) {
    const start = performance.now();
    try {
      return await this.answer(kind, words, Math.max(this.seconds, milliseconds / 1000));
    } finally {
      this.waited += performance.now() - start;
    }
  }

  async answer(kind, words, seconds) {
    try {
      if (kind === kOpen) {
        this.close();
        this.adapter = await within(this.open(), kOpeningSeconds);
        const problem = await within(selfCheck(this.adapter), kOpeningSeconds);
        if (problem) throw new Unsupported(`self-check of the adapter: ${problem}`);
        this.adapter.trust();
        return answered(kOk, infoWords(this.adapter.info));
      }
      if (kind === kDraw) {
        const scene = decodeScene(words);
        const image = await within(this.adapter.draw(scene), seconds);
        ++this.drawn;
        return answered(kOk, imageWords(scene, image));
      }
      this.close();
      return answered(kOk, new Uint32Array(0));
    } catch (error) {
      if (error instanceof Unsupported) return answered(kUnsupported, textWords(error.message));
      const text = error instanceof TooLate ? `no answer within ${kind === kOpen ? kOpeningSeconds : seconds} s` : String(error.message);
      if (error instanceof TooLate || this.adapter?.isLost) {
        this.close();
        return silent(error instanceof TooLate ? 2 : 1, text);
      }
      return answered(kFailed, textWords(text));
    }
  }

  close() {
    try {
      this.adapter?.close();
    } catch {
      // It was lost already.
    }
    this.adapter = null;
  }
}
