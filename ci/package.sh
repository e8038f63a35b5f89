#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The Debian package of the command, of what is built: the command, the plugins of this machine's drivers, the corpus, the headers of adapters,
# and ci/certify.sh.
#
#     ci/package.sh BUILD FOLDER        such as build/dev; needs dpkg-dev. Prints the package's path.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source_dir=$PWD
fail() { printf 'package: %s\n' "$*" >&2; exit 1; }
[ $# -eq 2 ] || fail "usage: ci/package.sh BUILD FOLDER"
command -v dpkg-shlibdeps >/dev/null || fail "dpkg-shlibdeps is missing (Debian's package dpkg-dev)"
[ -x "$1/certify/surefill" ] || fail "$1/certify/surefill was not built"
build=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
version=$(sed -n 's/.*SUREFILL_VERSION "\([^"]*\)".*/\1/p' engine/include/surefill/version.hpp)

install -D -s "$build/certify/surefill" "$root/usr/bin/surefill"
for driver in opengl vulkan; do
  plugin=$build/certify/libsurefill_$driver.so
  [ ! -f "$plugin" ] || install -D -s -m 644 "$plugin" "$root/usr/lib/surefill/$(basename "$plugin")"
done
mkdir -p "$root/usr/share/surefill/corpus" "$root/usr/share/doc/surefill" "$root/DEBIAN"
cp -r corpus/cases corpus/meshes "$root/usr/share/surefill/corpus"
cp -r vectors "$root/usr/share/surefill/vectors"
install -D -m 755 ci/certify.sh "$root/usr/share/surefill/ci/certify.sh"
for header in adapter.h adapter2.h; do install -D -m 644 "certify/$header" "$root/usr/include/certify/$header"; done
cp docs/adapters.md docs/certify-your-rasterizer.md "$root/usr/share/doc/surefill"
gzip -9nc CHANGELOG.md >"$root/usr/share/doc/surefill/changelog.gz"
printf 'Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nFiles: *\nCopyright: The Surefill authors\nLicense: Apache-2.0\n On Debian systems, the full text is in /usr/share/common-licenses/Apache-2.0.\n' \
  >"$root/usr/share/doc/surefill/copyright"

# What it depends on, and what the plugins of drivers do: who asks for those has a driver.
mkdir -p "$work/debian"
printf 'Source: surefill\n\nPackage: surefill\nArchitecture: any\n' >"$work/debian/control"
depends_of() { (cd "$work" && dpkg-shlibdeps -O --ignore-missing-info "$@" 2>/dev/null | sed -n 's/^shlibs:Depends=//p'); }
depends=$(depends_of "$root/usr/bin/surefill")
[ -n "$depends" ] || fail "dpkg-shlibdeps tells no dependencies"
recommends=""
if [ -d "$root/usr/lib/surefill" ]; then recommends=$(depends_of "$root"/usr/lib/surefill/*.so); fi
cat >"$root/DEBIAN/control" <<CONTROL
Package: surefill
Version: $version
Architecture: $(dpkg --print-architecture)
Maintainer: The Surefill authors <surefill@localhost>
Section: graphics
Priority: optional
Depends: $depends
${recommends:+Recommends: $recommends
}Installed-Size: $(du -sk "$root/usr" | cut -f1)
Description: exact triangle rasterizer - the command that certifies others
 Surefill certify holds a rasterizer (a plugin, a program over a pipe, a
 driver) against the exact answer, and says what it gets wrong, with a
 scene of mostly one triangle for each fault.
CONTROL
package=$out/surefill_${version}_$(dpkg --print-architecture).deb
find "$root" -type d -exec chmod 755 {} +
SOURCE_DATE_EPOCH=$(git -C "$source_dir" log -1 --format=%ct 2>/dev/null || echo 0) dpkg-deb --root-owner-group -b "$root" "$package" >/dev/null
printf '%s\n' "$package"
