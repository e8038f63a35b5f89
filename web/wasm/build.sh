#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# usage: web/wasm/build.sh FOLDER TOOLS
# Builds the judge of the page into FOLDER/judge.wasm. TOOLS/node_modules has npm's binaryen, whose asyncify makes calls of the GPU
# return later: the judge's C++ waits for an answer, and JavaScript goes on. Code is added to functions that may be waiting, and to
# no others: waits.mjs finds them, never_waits.txt says what it can't see. With CHECKED=1 each of the others stops the judge if it
# was left waiting (asyncify's asserts; larger and slower). Functions of similar names stand together: LZMA finds them more alike.
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
built=$folder/judge.wasm waits=$objects/waits.txt
if [ -z "${CHECKED:-}" ] && [ -f "$built" ] && [ -z "$(find "$linked" "$source"/{build.sh,waits.mjs,never_waits.txt} -newer "$built")" ]; then exit 0; fi
binaryen() { node "$tools/node_modules/binaryen/bin/$1" "${@:2}"; }
features="--enable-exception-handling --enable-bulk-memory --enable-mutable-globals --enable-sign-ext --enable-nontrapping-float-to-int"
binaryen wasm-opt "$linked" -o "$objects/small.wasm" $features -Oz -g
binaryen wasm-dis "$objects/small.wasm" -o "$objects/small.wat" $features
node "$source/waits.mjs" "$objects/small.wat" "$source/never_waits.txt" >"$waits"
binaryen wasm-opt "$objects/small.wasm" -o "$built" $features --asyncify --pass-arg=asyncify-imports@env.ask ${CHECKED:+--pass-arg=asyncify-asserts} \
  --pass-arg=asyncify-ignore-indirect --pass-arg=asyncify-propagate-addlist "--pass-arg=asyncify-addlist@@$waits" -Oz \
  --merge-similar-functions -Oz --reorder-functions-by-name --strip-debug --strip-producers
