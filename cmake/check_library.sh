#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The library as a stranger meets it: installed, found, linked, packaged, documented. Everything happens below one folder.
#
#     cmake/check_library.sh FOLDER                all checks
#     cmake/check_library.sh FOLDER --record-abi   all checks; then the C interface's ABI is the recorded one
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source_dir=$PWD
mkdir -p "$1"
work=$(cd "$1" && pwd)
recorded_abi=$source_dir/cmake/abi/surefill-$(sed -n 's/.*SUREFILL_VERSION "\([0-9]*\.[0-9]*\).*/\1/p' engine/include/surefill/version.hpp).abi
prefix=$work/prefix

fail() { printf 'check_library: %s\n' "$*" >&2; exit 1; }
say() { printf '   %s\n' "$*"; }
# run NAME COMMAND ...: its output goes to a log, of which the end is shown if it fails.
run() {
  local log=$work/$1.log
  shift
  "$@" >"$log" 2>&1 || { tail -n 40 "$log" >&2; fail "failed: $* ($log)"; }
}
# build FOLDER SOURCE OPTION ...: configures and builds.
build() {
  local folder=$1 source=$2
  shift 2
  run "$folder-configure" cmake -S "$source" -B "$work/$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "${launcher[@]}" "$@"
  run "$folder-build" cmake --build "$work/$folder"
}
ctests() { run "$1-test" ctest --test-dir "$work/$1" --output-on-failure --no-tests=error; }
# The engine is built in several ways; what is compiled alike is compiled once.
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
compilers=(g++:gcc)
command -v clang++-19 >/dev/null && compilers+=(clang++-19:clang-19)
strict="-Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Werror"

# ---------------------------------------------------------------- install
# Only what is installed is there for those who find it.
rm -rf "$prefix"
started=$SECONDS
build engine . -DSUREFILL_SUITE=OFF -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_INSTALL_LIBDIR=lib
say "engine built in $((SECONDS - started)) s"
run install cmake --install "$work/engine" --prefix "$prefix"
installed=$(cd "$prefix" && find . -type f | grep -v -e '^\./include/surefill/' -e '^\./lib/cmake/surefill/' -e '^\./share/doc/' | sort | tr '\n' ' ')
[ "$installed" = "./lib/libsurefill.a ./lib/pkgconfig/surefill.pc " ] || fail "installed besides headers and package: $installed"

cp "$prefix/lib/libsurefill.a" "$work/stripped.a"
strip --strip-unneeded "$work/stripped.a"
size=$(stat -c %s "$work/stripped.a")
say "static library, stripped: $size bytes"
[ "$size" -lt 1300000 ] || fail "the static library has $size bytes stripped; under 1.3 MB is promised"

for header in surefill.hpp occlusion.hpp surefill.h; do
  echo "#include \"surefill/$header\"" >"$work/include_$header.cpp"
  foreign=$(g++ -std=c++20 -I"$prefix/include" -M "$work/include_$header.cpp" | tr -s ' \\' '\n' | grep '^/' |
    grep -v -e "^$work/" -e '^/usr/include/c++/' -e '^/usr/lib/gcc/' -e '^/usr/include/[^/]*\.h$' \
      -e '^/usr/include/[^/]*-linux-gnu/' -e '^/usr/include/\(asm\|bits\|sys\|linux\|gnu\|asm-generic\)' || true)
  [ -z "$foreign" ] || fail "$header includes $foreign"
  # Processor time, which other programs of the machine do not change.
  seconds=$(TIMEFORMAT=%U; { time g++ -std=c++20 $strict -I"$prefix/include" -c "$work/include_$header.cpp" -o "$work/include.o" >&2; } 2>&1)
  say "$header compiles in $seconds s"
  [[ $seconds == 0.* ]] || fail "$header takes $seconds s; under 1 s is promised"
done

# ---------------------------------------------------------------- projects outside the tree
for pair in "${compilers[@]}"; do
  cxx=${pair%%:*} cc=${pair##*:}
  tools=(-DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc")
  build "examples-$cxx" examples "${tools[@]}" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS=-Werror -DCMAKE_C_FLAGS=-Werror
  ctests "examples-$cxx"
  say "$(sed -n 's/.*out of \([0-9]*\)/\1/p' "$work/examples-$cxx-test.log") examples give their output, by find_package and $cxx"
  for how in package subdirectory fetch; do
    build "outside-$how-$cxx" examples/outside "${tools[@]}" -DHOW=$how -DCMAKE_PREFIX_PATH="$prefix" -DSUREFILL_SOURCE="$source_dir"
    "$work/outside-$how-$cxx/outside" | cmp - examples/expected/overdraw.txt
    "$work/outside-$how-$cxx/outside_c" >/dev/null
  done
  flags=$(PKG_CONFIG_PATH=$prefix/lib/pkgconfig pkg-config --cflags --libs surefill)
  "$cc" -std=c99 $strict examples/triangle.c -o "$work/triangle" $flags
  "$work/triangle" | cmp - examples/expected/triangle.txt
  say "$cxx: find_package, add_subdirectory, FetchContent; $cc: pkg-config"
done

# ---------------------------------------------------------------- the ABI of the C interface
# Line numbers and folders are no part of it; debug information is where the types are.
build shared . -DSUREFILL_SUITE=OFF -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS=-ffile-prefix-map=$source_dir/="
foreign=$(nm -D --defined-only "$work/shared/engine/libsurefill.so" | awk '{print $3}' | grep -v -e '^surefill_' -e '^_ZNK\?8surefill' || true)
[ -z "$foreign" ] || fail "the shared library shows $foreign"
abidw --exported-interfaces-only --suppressions cmake/abi/c-only.abignore --headers-dir engine/include/surefill \
  --drop-private-types --no-corpus-path --no-comp-dir-path --no-show-locs --no-elf-needed --type-id-style hash \
  --out-file "$work/surefill.abi" "$work/shared/engine/libsurefill.so"
# Where the sources lie is no part of it.
[ "${2:-}" != --record-abi ] || sed "s#path='[^']*/\(engine/src/\)#path='\1#" "$work/surefill.abi" >"$recorded_abi"
[ -f "$recorded_abi" ] || fail "no ABI is recorded for this minor version (--record-abi does it)"
run abidiff abidiff --no-added-syms "$recorded_abi" "$work/surefill.abi"
say "the C interface's ABI is the recorded one; $(nm -D --defined-only "$work/shared/engine/libsurefill.so" | wc -l) symbols are visible, all surefill's"

# ---------------------------------------------------------------- the Debian package
(cd "$work/engine" && run package cpack -B "$work/package")
package=$(ls "$work"/package/*.deb)
dpkg-deb -c "$package" >"$work/contents.txt"
for file in include/surefill/surefill.hpp include/surefill/surefill.h lib/libsurefill.a lib/pkgconfig/surefill.pc \
  lib/cmake/surefill/surefill-config.cmake share/doc/libsurefill-dev/copyright share/doc/libsurefill-dev/changelog.gz; do
  grep -q " ./usr/$file\$" "$work/contents.txt" || fail "the Debian package lacks /usr/$file"
done
# Installed and removed in a root of its own, so that the machine's stays as it is.
root=$work/root
rm -rf "$root"
mkdir -p "$root/var/lib/dpkg/updates" "$root/var/lib/dpkg/info"
touch "$root/var/lib/dpkg/status"
in_root() { run dpkg dpkg --root="$root" --log="$work/dpkg-actions.log" --force-not-root --force-depends --force-script-chrootless "$@"; }
in_root -i "$package"
[ -f "$root/usr/lib/libsurefill.a" ] || fail "the Debian package did not install"
in_root -P libsurefill-dev
left=$(cd "$root" && find . -not -path './var*' -not -name . | sort)
[ -z "$left" ] || fail "the Debian package leaves behind $left"
say "$(basename "$package") installs and removes cleanly"

# ---------------------------------------------------------------- the API reference
mkdir -p "$work/api"
OUT=$work/api run doxygen doxygen docs/Doxyfile
undocumented=$( (cat docs/Doxyfile; printf 'EXTRACT_ALL = NO\nWARN_AS_ERROR = NO\n') | OUT=$work/api doxygen - 2>&1 |
  grep -v -e '(variable) of struct' -e '(variable) of class' || true)
[ -z "$undocumented" ] || fail "undocumented: $undocumented"
say "doxygen has no warnings; every type, function and macro is documented"

# ---------------------------------------------------------------- Python
python=/usr/bin/python3
"$python" -c 'import numpy, pip' 2>/dev/null || fail "python3-numpy or python3-pip is missing"
build python python -DCMAKE_PREFIX_PATH="$prefix" -DPython3_EXECUTABLE="$python"
ctests python
say "Python: tests, recipes and example pass"
# The wheel, as pip makes and installs it without network; where it lies there is nothing else.
rm -rf "$work/wheels" "$work/site"
run wheel "$python" -m pip wheel . --no-deps --no-index --wheel-dir "$work/wheels" --config-settings package="$work/python/surefill"
wheel=$(ls "$work"/wheels/surefill-*.whl)
[[ $wheel == *-py3-none-manylinux_* ]] || fail "the wheel is tagged for this machine alone: $(basename "$wheel")"
run wheel-install "$python" -m pip install --no-deps --no-index --no-compile --target "$work/site" "$wheel"
(cd "$work" && PYTHONPATH=$work/site PYTHONDONTWRITEBYTECODE=1 "$python" "$source_dir/examples/picture.py") | cmp - examples/expected/picture.txt
say "$(basename "$wheel"), $(stat -c %s "$wheel") bytes, installs and draws"
if command -v mypy >/dev/null; then
  (cd python && run mypy mypy --strict --cache-dir "$work/mypy" --config-file ../pyproject.toml -p surefill)
  say "mypy --strict has nothing to say"
else
  fail "mypy is missing"
fi
