#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The subjects that are made in seconds, made anew and compared byte for byte: remade.sh SUREFILL. The others take minutes
# (surefill vectors --make all). The effects in the notes are left out: they are those of all subjects together.
set -euo pipefail
surefill=$1 folder=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
subjects=(coverage_exact behind_the_eye values_grid8 attributes depth)
"$surefill" vectors --make "${subjects[@]}" --folder "$work"
differing=0
for subject in "${subjects[@]}"; do
  for file in "$subject.json" "$subject.txt" "$subject.faults.txt" "schemas/$subject.json"; do
    if ! cmp <(sed 's/"effect": "[^"]*"//' "$work/$file") <(sed 's/"effect": "[^"]*"//' "$folder/$file"); then
      echo "vectors/$file is not what is made today"
      differing=1
    fi
  done
done
[ "$differing" = 0 ] && echo "${#subjects[@]} subjects made anew, equal"
