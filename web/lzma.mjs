// SPDX-License-Identifier: Apache-2.0
//
// Reads .lzma files (LZMA alone, as `xz --format=lzma` writes them; the LZMA specification of I. Pavlov, 2015): a fifth smaller than
// gzip for the judge, and browsers have no format of their own that is.
const kBits = 11, kHalf = 1 << (kBits - 1), kMove = 5, kTop = 2 ** 24;
const kMatchMin = 2, kLengthStates = 4, kEndSlot = 14, kAlign = 4;

// Bytes of the file `input`. Throws where it is no such file, or ends too early.
export function unpackLzma(input) {
  if (input.length < 18 || input[0] >= 9 * 5 * 5) throw new Error("no .lzma file");
  const lc = input[0] % 9, lp = Math.floor(input[0] / 9) % 5, pb = Math.floor(input[0] / 45);
  const header = new DataView(input.buffer, input.byteOffset, 13);
  // The size may be unknown, all ones: then a mark ends the data.
  const known = header.getUint32(9, true) !== 0xffffffff;
  let output = new Uint8Array(known ? header.getUint32(5, true) : 4 * input.length), written = 0;

  let at = 18, code = new DataView(input.buffer, input.byteOffset + 14, 4).getUint32(0), range = 0xffffffff;
  const normalized = () => {
    if (range >= kTop) return;
    if (at >= input.length) throw new Error("the .lzma file ends too early");
    range = range * 256;
    code = ((code << 8) | input[at++]) >>> 0;
  };
  const bit = (odds, i) => {
    const bound = (range >>> kBits) * odds[i];
    let result = 0;
    if (code < bound) {
      range = bound;
      odds[i] += ((1 << kBits) - odds[i]) >> kMove;
    } else {
      range -= bound;
      code -= bound;
      odds[i] -= odds[i] >> kMove;
      result = 1;
    }
    normalized();
    return result;
  };
  const evenBits = (count) => {
    let result = 0;
    for (let i = 0; i < count; ++i) {
      range >>>= 1;
      const one = code >= range ? 1 : 0;
      if (one) code -= range;
      normalized();
      result = 2 * result + one;
    }
    return result;
  };
  const tree = (odds, bits, base = 0) => {
    let node = 1;
    for (let i = 0; i < bits; ++i) node = 2 * node + bit(odds, base + node);
    return node - (1 << bits);
  };
  // Lowest bit first.
  const reverseTree = (odds, bits, base = 0) => {
    let node = 1, result = 0;
    for (let i = 0; i < bits; ++i) {
      const one = bit(odds, base + node);
      node = 2 * node + one;
      result |= one << i;
    }
    return result;
  };
  const even = (size) => new Uint16Array(size).fill(kHalf);
  const lengths = () => ({ choice: even(2), low: even(8 << 4), middle: even(8 << 4), high: even(256) });
  const lengthOf = ({ choice, low, middle, high }, place) => {
    if (!bit(choice, 0)) return tree(low, 3, 8 * place);
    if (!bit(choice, 1)) return 8 + tree(middle, 3, 8 * place);
    return 16 + tree(high, 8);
  };

  const literals = even(0x300 << (lc + lp)), isMatch = even(12 << 4), isRepeat = even(12), isFirst = even(12), isSecond = even(12), isThird = even(12),
    isLong = even(12 << 4), slots = even(64 * kLengthStates), places = even(128), align = even(1 << kAlign), matched = lengths(), repeated = lengths();
  let state = 0, distances = [0, 0, 0, 0];
  const append = (byte) => {
    if (written === output.length) {
      if (known) throw new Error("the .lzma file holds more than it says");
      const larger = new Uint8Array(2 * output.length);
      larger.set(output);
      output = larger;
    }
    output[written++] = byte;
  };
  const back = () => {
    if (distances[0] >= written) throw new Error("the .lzma file refers to what is not there");
    return output[written - 1 - distances[0]];
  };
  const literal = () => {
    const before = written > 0 ? output[written - 1] : 0;
    const base = 0x300 * (((written & ((1 << lp) - 1)) << lc) + (before >> (8 - lc)));
    let node = 1;
    if (state >= 7) {
      let guide = back();
      do {
        const expected = (guide >> 7) & 1, one = bit(literals, base + ((1 + expected) << 8) + node);
        guide <<= 1;
        node = 2 * node + one;
        if (one !== expected) break;
      } while (node < 0x100);
    }
    while (node < 0x100) node = 2 * node + bit(literals, base + node);
    append(node & 0xff);
    state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
  };
  const distance = (length) => {
    const slot = tree(slots, 6, 64 * Math.min(length, kLengthStates - 1));
    if (slot < 4) return slot;
    const low = (slot >> 1) - 1, start = (2 | (slot & 1)) * 2 ** low;
    if (slot < kEndSlot) return start + reverseTree(places, low, start - slot);
    return start + evenBits(low - kAlign) * (1 << kAlign) + reverseTree(align, kAlign);
  };

  while (!known || written < output.length) {
    const place = written & ((1 << pb) - 1);
    if (!bit(isMatch, (state << 4) + place)) {
      literal();
      continue;
    }
    let length;
    if (!bit(isRepeat, state)) {
      length = lengthOf(matched, place);
      distances = [distance(length), ...distances.slice(0, 3)];
      if (distances[0] === 0xffffffff) break;
      state = state < 7 ? 7 : 10;
    } else {
      if (!bit(isFirst, state)) {
        if (!bit(isLong, (state << 4) + place)) {
          state = state < 7 ? 9 : 11;
          append(back());
          continue;
        }
      } else {
        const which = !bit(isSecond, state) ? 1 : !bit(isThird, state) ? 2 : 3;
        distances.unshift(...distances.splice(which, 1));
      }
      length = lengthOf(repeated, place);
      state = state < 7 ? 8 : 11;
    }
    for (length += kMatchMin; length > 0 && (!known || written < output.length); --length) append(back());
  }
  return output.subarray(0, written);
}
