#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# usage: web/wasm/build.sh FOLDER TOOLS
# Builds the judge of the page into FOLDER/judge.wasm. TOOLS/node_modules has npm's binaryen, whose asyncify makes calls of the GPU
# return later: the judge's C++ waits for an answer, and JavaScript goes on. never_waits.txt are functions during which it never waits.
set -euo pipefail
source=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
folder=$(realpath -m "$1") tools=$(realpath "$2")
objects=$folder/objects
mkdir -p "$objects"
cmake -G Ninja -S "$source" -B "$objects" -DCMAKE_BUILD_TYPE=Release -DCMAKE_SYSTEM_NAME=Generic -DCMAKE_SYSTEM_PROCESSOR=wasm32 \
  -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_CXX_COMPILER_TARGET=wasm32-wasi -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY \
  "-DCMAKE_CXX_FLAGS_RELEASE=-Oz" >"$objects/configure.log"
cmake --build "$objects"
linked=$objects/surefill_page.wasm
[ "$linked" -nt "$folder/judge.wasm" ] || [ "$source/never_waits.txt" -nt "$folder/judge.wasm" ] || exit 0
node "$tools/node_modules/binaryen/bin/wasm-opt" "$linked" -o "$folder/judge.wasm" \
  --enable-exception-handling --enable-bulk-memory --enable-mutable-globals --enable-sign-ext --enable-nontrapping-float-to-int \
  -Oz --asyncify --pass-arg=asyncify-imports@env.ask "--pass-arg=asyncify-removelist@@$source/never_waits.txt" -Oz \
  --strip-debug --strip-producers
