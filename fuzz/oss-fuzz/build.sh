#!/bin/bash -eu
# SPDX-License-Identifier: Apache-2.0
# Builds the fuzz targets as OSS-Fuzz and ClusterFuzzLite ask for it, with their variables:
#   CC CXX CFLAGS CXXFLAGS LIB_FUZZING_ENGINE SANITIZER (address, undefined, coverage) OUT; WORK and SRC if there are.
# Leaves in $OUT: the targets, TARGET_seed_corpus.zip, TARGET.dict, TARGET.options, and lib/ with what they load.
: "${CC:?}" "${CXX:?}" "${CFLAGS?}" "${CXXFLAGS?}" "${LIB_FUZZING_ENGINE:?}" "${OUT:?}"
source_directory=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${WORK:-/tmp}/surefill-${SANITIZER:-address}
mkdir -p "$OUT/lib"

# libc++, which the fuzzing images use, cannot be mixed with the distribution's C++ libraries: these two are built here if
# their sources are (Dockerfile).
prefix=$build/prefix
for library in fmt tinyobjloader; do
  [ -d "${SRC:-/nonexistent}/$library" ] || continue
  cmake -S "$SRC/$library" -B "$build/$library" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DBUILD_SHARED_LIBS=OFF -DFMT_TEST=OFF -DFMT_DOC=OFF
  cmake --build "$build/$library" --target install
done

# No build type: the optimisation is that of CXXFLAGS.
cmake -S "$source_directory" -B "$build/build" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_C_FLAGS="$CFLAGS" -DCMAKE_CXX_FLAGS="$CXXFLAGS" \
  -DSUREFILL_FUZZ=ON -DSUREFILL_FUZZ_ENGINE="$LIB_FUZZING_ENGINE" -DCMAKE_BUILD_RPATH='$ORIGIN/lib' \
  -DCMAKE_BUILD_RPATH_USE_ORIGIN=ON
cmake --build "$build/build" --target surefill_fuzz

for program in "$build"/build/fuzz/*_fuzz; do
  name=$(basename "$program")
  target=${name%_fuzz}
  cp "$program" "$OUT/$name"
  seeds=$build/build/fuzz/seeds/$target
  rm -f "$OUT/${name}_seed_corpus.zip"
  (cd "$seeds" && find . -type f -print0 | sort -z | xargs -0 python3 -m zipfile -c "$OUT/${name}_seed_corpus.zip")
  printf '[libfuzzer]\nmax_len = 4096\ntimeout = 25\n' >"$OUT/$name.options"
  if [ -f "$source_directory/fuzz/$target.dict" ]; then
    cp "$source_directory/fuzz/$target.dict" "$OUT/$name.dict"
    printf 'dict = %s.dict\n' "$name" >>"$OUT/$name.options"
  fi
  # The machine that runs them has no GMP, MPFR or Highway.
  ldd "$program" | awk '/lib(gmp|gmpxx|mpfr|hwy|fmt|tinyobjloader|png16)[.]/ && $3 ~ /^\// { print $3 }' |
    xargs -r cp -L -t "$OUT/lib"
done
ls "$OUT"
