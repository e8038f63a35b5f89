#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: fuzz/oss-fuzz/try.sh [SANITIZER ...]   (default: address undefined coverage)
# Runs build.sh here as OSS-Fuzz's builder runs it, with its variables and flags for clang and libFuzzer (but for libc++, which a
# distribution's C++ libraries cannot be mixed with), lists $OUT, and runs every target of it once on its seed corpus, with the
# target's options. Exit 1 if a target finds something or its seeds are missing. Results: build/oss-fuzz/SANITIZER.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

export CC=${CC:-clang-19} CXX=${CXX:-clang++-19} LIB_FUZZING_ENGINE=-fsanitize=fuzzer FUZZING_ENGINE=libfuzzer ARCHITECTURE=x86_64
export UBSAN_OPTIONS=silence_unsigned_overflow=1  # OSS-Fuzz takes them as a signal of coverage, not as findings
common="-O1 -fno-omit-frame-pointer -gline-tables-only -DFUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION"
recoverable=array-bounds,bool,builtin,enum,function,integer-divide-by-zero,null,object-size,return
recoverable+=,returns-nonnull-attribute,shift,signed-integer-overflow,unreachable,vla-bound,vptr

flags_of() {
  case $1 in
    address) echo "-fsanitize=address -fsanitize-address-use-after-scope -fsanitize=fuzzer-no-link" ;;
    undefined)
      echo "-fsanitize=$recoverable,unsigned-integer-overflow -fno-sanitize-recover=$recoverable -fsanitize=fuzzer-no-link" ;;
    coverage) echo "-fprofile-instr-generate -fcoverage-mapping -pthread -Wno-unused-command-line-argument" ;;
    *) echo "try.sh: no such sanitizer: $1 (there are: address undefined coverage)" >&2; return 1 ;;
  esac
}

# run_target OUT NAME: the target on its seeds, once each, as a runner would: from $OUT alone.
run_target() {
  local out=$1 name=$2 seeds="$1/../seeds/$2" options=()
  rm -rf "$seeds" && mkdir -p "$seeds"
  python3 -m zipfile -e "$out/${name}_seed_corpus.zip" "$seeds"
  while IFS='= ' read -r key value; do
    case $key in
      dict) options+=("-dict=$out/$value") ;;
      max_len | timeout) options+=("-$key=$value") ;;
    esac
  done <"$out/$name.options"
  printf '%-24s %5d seeds: ' "$name" "$(find "$seeds" -type f | wc -l)"
  if ! LLVM_PROFILE_FILE="$out/../$name.profraw" "$out/$name" "${options[@]}" -runs=0 "$seeds" >"$out/../$name.log" 2>&1; then
    echo "fails"
    tail -n 30 "$out/../$name.log" >&2
    return 1
  fi
  grep -oE "Done [0-9]+ runs in [0-9]+ second" "$out/../$name.log" || { echo "did not run"; return 1; }
}

[ $# -gt 0 ] || set -- address undefined coverage
for sanitizer in "$@"; do
  flags=$(flags_of "$sanitizer")
  base="$PWD/build/oss-fuzz/$sanitizer"
  rm -rf "$base/out"
  mkdir -p "$base/out" "$base/work"
  echo "== $sanitizer: build.sh (build/oss-fuzz/$sanitizer/build.log)"
  SANITIZER=$sanitizer CFLAGS="$common $flags" CXXFLAGS="$common $flags" OUT="$base/out" WORK="$base/work" \
    fuzz/oss-fuzz/build.sh >"$base/build.log" 2>&1 || { tail -n 30 "$base/build.log" >&2; exit 1; }
  echo "== $sanitizer: ls \$OUT"
  ls -C "$base/out"
  echo "== $sanitizer: every target on its seeds"
  for program in "$base"/out/*_fuzz; do run_target "$base/out" "$(basename "$program")"; done
done
