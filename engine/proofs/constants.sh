#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The constants of scripts and sources are those that were compared: constants.txt names, for each script, what it proves or takes
# for granted, and the text of a source that relies on it. Fails if a script is not named, or a text is no longer there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

fail() { printf 'constants: %s\n' "$*" >&2; exit 1; }

rows=0
for script in *.g; do
  [ -f "$script" ] || fail "no scripts"
  grep -q "^$script | " constants.txt || fail "$script is not in engine/proofs/constants.txt"
done
while IFS= read -r line; do
  [[ $line == \#* ]] && continue
  script=${line%% | *} rest=${line#* | }
  said=${rest%% | *} rest=${rest#* | }
  used=${rest%% | *}
  [ -f "$script" ] || fail "engine/proofs/constants.txt names $script, which is not there"
  grep -vE '^#' "$script" | grep -qF -- "$said" || fail "engine/proofs/$script no longer says \"$said\" (constants.txt): look at $used"
  grep -rqF --include='*.?pp' -- "$used" ../src || fail "engine/src no longer has \"$used\" (constants.txt): look at $script"
  rows=$((rows + 1))
done <constants.txt
echo "$rows pairs of a script and a source agree"
