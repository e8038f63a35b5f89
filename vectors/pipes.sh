#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every subject through both pipes: pipes.sh SUREFILL PROGRAM. Then an answer with a fault, which has to be found.
set -euo pipefail
surefill=$1 program=$2 folder=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for file in "$folder"/*.json; do
  subject=$(basename "$file" .json)
  "$surefill" vectors --folder "$folder" --text "$subject" | "$program" >"$work/$subject.txt"
done
# The tests of the smoke set are those of the others: twice the same answer is a fault.
cat $(ls "$work"/*.txt | grep -v /smoke.txt) >"$work/all"
"$surefill" verify --folder "$folder" --text <"$work/all"
"$surefill" verify --folder "$folder" "$work/smoke.txt"
# One sample of one count; then a line that is missing.
sed '1s/ 1 0 / 1 7 /' "$work/all" >"$work/wrong"
if "$surefill" verify --folder "$folder" "$work/wrong"; then echo "a wrong count was not found"; exit 1; fi
sed 1d "$work/all" >"$work/short"
if "$surefill" verify --folder "$folder" "$work/short" >"$work/said"; then echo "a missing line was not found"; exit 1; fi
grep -q "1 of the same files without an answer" "$work/said"
