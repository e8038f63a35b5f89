#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The seeds of all fuzz targets on aarch64, emulated: each target is built for it, oracles included, and replays its seeds.
# Debian's libraries for aarch64 are unpacked into build/elsewhere/sysroot, and nothing is installed.
#
#     elsewhere/fuzz.sh [MUTATIONS]      of each seed (default: 0)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mutations=${1:-0}
libraries="libcgal-dev libgmp-dev libmpfr-dev libfmt-dev libcli11-dev nlohmann-json3-dev libhwy-dev libtbb-dev libpng-dev
  libtinyobjloader-dev libgtest-dev librapidcheck-dev libstdc++-12-dev libc6-dev"
place=$PWD/build/elsewhere/sysroot
root=$place/root
out=build/elsewhere/fuzz-aarch64
mkdir -p "$place/lists/partial" "$place/cache/archives/partial" "$root" "$out"

if [ ! -f "$place/complete" ]; then
  apt=(apt-get -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o "Dir::State::lists=$place/lists" -o "Dir::Cache=$place/cache"
    -o Dir::State::status=/dev/null -o Debug::NoLocking=1)
  "${apt[@]}" update -qq
  # shellcheck disable=SC2086
  "${apt[@]}" install --download-only -y -qq --no-install-recommends $libraries >"$place/apt.log"
  for package in "$place"/cache/archives/*.deb; do dpkg -x "$package" "$root"; done
  # Links that lead from the root lead from the system's, here.
  find "$root" -type l -lname '/*' | while IFS= read -r link; do ln -sfnr "$root$(readlink "$link")" "$link"; done
  touch "$place/complete"
fi

cmake -G Ninja -S . -B "$out" -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc \
  -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DCMAKE_SYSROOT="$root" -DCMAKE_LIBRARY_ARCHITECTURE=aarch64-linux-gnu \
  -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY \
  -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 \
  "-DCMAKE_CROSSCOMPILING_EMULATOR=qemu-aarch64;-L;$root" >"$out/configure.log"
cmake --build "$out" --target surefill_fuzz >"$out/build.log" || { tail -n 20 "$out/build.log" >&2; exit 1; }

failed=0
for program in "$out"/fuzz/*_replay; do
  target=$(basename "$program" _replay)
  begun=$SECONDS
  answer=$(qemu-aarch64 -L "$root" "$program" --mutations "$mutations" "$out/fuzz/seeds/$target" 2>&1 | tail -n 3) || failed=1
  printf '%-18s %s (%d s)\n' "$target" "$answer" $((SECONDS - begun))
done
exit $failed
