// SPDX-License-Identifier: Apache-2.0
//
// The judge (web/wasm) for JavaScript. It calls the rasterizer and waits; asyncify makes that a call that returns at once, and goes
// on where it was when the answer is there.
const kStack = 1 << 20;  // bytes of the judge's own stack that are kept while it waits
const kLevels = ["quick", "standard", "thorough"];
const kTold = ["line", "certificate", "report", "unopened", "error", "verdict"];
const kNormal = 0, kUnwinding = 1, kRewinding = 2;
const kNoFile = 8;  // of WASI: nothing is open here

export class Judge {
  // `ask(kind, words, most, milliseconds)` promises { outcome, status, words } (conversation.mjs). `tell(what, text)`: what is one of
  // kTold. `progress(check, checks, share)`: a case is done.
  static async open(bytes, { ask, tell, progress = () => {} }) {
    const judge = new Judge();
    judge.ask = ask;
    judge.told = {};
    const env = {
      ask: (...request) => judge.asked(...request),
      tell: (kind, text, size) => {
        judge.told[kTold[kind]] = judge.text(text, size);
        tell(kTold[kind], judge.told[kTold[kind]]);
      },
      progress,
    };
    const system = {
      clock_time_get: (clock, precision, at) => {
        const milliseconds = clock === 0 ? Date.now() : performance.now();
        new BigUint64Array(judge.memory.buffer, at, 1)[0] = BigInt(Math.round(milliseconds * 1e6));
        return 0;
      },
      environ_sizes_get: (count, size) => {
        new Uint32Array(judge.memory.buffer, count, 1)[0] = new Uint32Array(judge.memory.buffer, size, 1)[0] = 0;
        return 0;
      },
      environ_get: () => 0,
      proc_exit: (status) => {
        throw new Error(`the judge ended with status ${status}`);
      },
    };
    const wasi = new Proxy(system, { get: (calls, name) => calls[name] ?? (() => kNoFile) });
    const { instance } = await WebAssembly.instantiate(bytes, { env, wasi_snapshot_preview1: wasi });
    judge.calls = instance.exports;
    judge.memory = instance.exports.memory;
    instance.exports._initialize();
    judge.stack = instance.exports.malloc(kStack);
    new Uint32Array(judge.memory.buffer, judge.stack, 2).set([judge.stack + 8, judge.stack + kStack]);
    return judge;
  }

  text(at, size) {
    return new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, size));
  }

  // Where a text lies, which ends with 0, and its size; the caller's to free.
  place(text) {
    const bytes = new TextEncoder().encode(text);
    const at = this.calls.malloc(bytes.length + 1);
    new Uint8Array(this.memory.buffer, at, bytes.length + 1).set([...bytes, 0]);
    return [at, bytes.length];
  }

  asked(kind, words, count, most, milliseconds) {
    if (this.calls.asyncify_get_state() === kRewinding) {
      this.calls.asyncify_stop_rewind();
      return this.answer;
    }
    this.pending = this.ask(kind, new Uint32Array(this.memory.buffer.slice(words, words + 4 * count)), most, milliseconds);
    this.calls.asyncify_start_unwind(this.stack);
    return 0;
  }

  async run(name, ...request) {
    this.told = {};
    this.calls[name](...request);
    while (this.calls.asyncify_get_state() === kUnwinding) {
      this.calls.asyncify_stop_unwind();
      const { outcome, status, words } = await this.pending;
      this.answer = this.calls.malloc(4 * (3 + words.length));
      const answer = new Uint32Array(this.memory.buffer, this.answer, 3 + words.length);
      answer.set([outcome, status, words.length]);
      answer.set(words, 3);
      this.calls.asyncify_start_rewind(this.stack);
      this.calls[name](...request);
    }
    if (this.calls.asyncify_get_state() !== kNormal) throw new Error("the judge is in no state to go on");
    return this.told;
  }

  addFile(path, text) {
    const name = this.place(path), content = this.place(text);
    this.calls.surefill_add_file(...name, ...content);
    this.calls.free(name[0]);
    this.calls.free(content[0]);
  }

  // `corpus`: files, each after a line "=== PATH" (web/build.mjs). They come back as a map.
  addCorpus(corpus) {
    const files = new Map(corpus.split(/^=== /m).slice(1).map((part) => {
      const end = part.indexOf("\n");
      return [part.slice(0, end), part.slice(end + 1)];
    }));
    for (const [path, text] of files) this.addFile(path, text);
    return files;
  }

  // What it told: the last of each kind.
  async certify({ level = "quick", seed = 1n, checks = "", machine = "unknown", seconds = 20 }) {
    const number = BigInt(seed), half = (part) => Number(part & 0xffffffffn) | 0;
    const texts = [this.place(checks)[0], this.place(machine)[0]];
    return this.run("surefill_certify", Math.max(0, kLevels.indexOf(level)), half(number), half(number >> 32n), seconds, ...texts);
  }

  async judgeScene({ scene, seconds = 20 }) {
    return this.run("surefill_judge_scene", seconds, this.place(scene)[0]);
  }

  // Ends the run after the case that it is at.
  stop() {
    this.calls.surefill_stop();
  }
}
