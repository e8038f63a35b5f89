#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs what action.yml and ci/gitlab.yml run, with the package that ci/package.sh makes, unpacked into a folder of its own where nothing of the
# project is seen: a right rasterizer, a wrong one, and a variable that is not set.
#
#     ci/try.sh BUILD FOLDER        such as build/dev
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
fail() { printf 'try: %s\n' "$*" >&2; exit 1; }
[ $# -eq 2 ] || fail "usage: ci/try.sh BUILD FOLDER"
build=$(cd "$1" && pwd)
mkdir -p "$2"
work=$(cd "$2" && pwd)
rm -rf "${work:?}"/{root,*.deb,right,wrong,unset}
package=$(ci/package.sh "$build" "$work")
dpkg-deb -x "$package" "$work/root"
export PATH=$work/root/usr/bin:$PATH
# On other machines the tree that it was built in is not there: its path becomes one of the same length that names nothing.
nowhere=$(printf '%s' "$PWD/corpus" | tr -c / x)
LC_ALL=C sed -i "s|$PWD/corpus|$nowhere|g" "$work/root/usr/bin/surefill"
[ "$(command -v surefill)" = "$work/root/usr/bin/surefill" ] || fail "another surefill is first on the PATH"

# The variables that the action sets are those that the script reads.
set_by_action=$(grep -o '^ *SUREFILL_[A-Z0-9]*:' action.yml | tr -d ' :' | sort)
read_by_script=$(grep -o 'SUREFILL_[A-Z0-9]*' ci/certify.sh | sort -u | grep -v '^SUREFILL_$')
for name in $set_by_action; do grep -qx "$name" <<<"$read_by_script" || fail "ci/certify.sh does not read $name"; done
for name in $read_by_script; do grep -qx "$name" <<<"$set_by_action" || fail "action.yml does not set $name"; done

# job NAME STATUS VERDICT VARIABLE=VALUE ...: a job in a folder of its own.
job() {
  local name=$1 expected=$2 verdict=$3 status=0
  shift 3
  mkdir -p "$work/$name"
  (cd "$work/$name" && env GITHUB_STEP_SUMMARY=summary.md GITHUB_OUTPUT=output.txt "$@" \
    bash "$work/root/usr/share/surefill/ci/certify.sh" >log.txt 2>&1) || status=$?
  [ "$status" = "$expected" ] || { tail -n 20 "$work/$name/log.txt" >&2; fail "$name: exit status $status, not $expected"; }
  [ -z "$verdict" ] || grep -qx "verdict=$verdict" "$work/$name/output.txt" || fail "$name: no verdict \"$verdict\""
  [ -z "$verdict" ] || grep -q "^## Surefill: $verdict" "$work/$name/summary.md" || fail "$name: the summary lacks it"
}
only="--only partition-fan,degree-spot,model-corpus"
job right 0 "certified" SUREFILL_PLUGIN="$build/certify/libsurefill_fixed_point.so" SUREFILL_OPTIONS="$only"
job wrong 1 "not certified" SUREFILL_PLUGIN="$build/certify/libsurefill_float_edges.so" SUREFILL_OPTIONS="$only"
for name in right wrong; do
  for file in certificate.json report.xml report.html report.txt; do
    [ -s "$work/$name/surefill-report/$file" ] || fail "$name: no $file"
  done
done
grep -q '<failure' "$work/wrong/surefill-report/report.xml" || fail "wrong: JUnit names no failure"
ls "$work"/wrong/surefill-report/*.scene >/dev/null || fail "wrong: no reduced scene"
job unset 2 "" SUREFILL_PLUGIN= SUREFILL_COMMAND=
grep -q "exactly one of" "$work/unset/log.txt" || fail "unset: it says nothing"
job gone 2 "nothing judged" SUREFILL_COMMAND="no-such-program"
printf '%s: %s bytes; right, wrong, unset and gone end as they should\n' "$(basename "$package")" "$(stat -c %s "$package")"
