#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Has Coq check gappa's proofs: every script of engine/proofs, so that gappa's word is not taken for the error bounds.
#
#     proofs/gappa.sh FOLDER      build products go to FOLDER
set -euo pipefail
mkdir -p "$1"
work=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/../engine/proofs"
begun=$SECONDS

fail() { printf 'gappa: %s\n' "$*" >&2; exit 1; }

# What Coq's real numbers rest on, and nothing else.
allowed='ClassicalDedekindReals.sig_(forall_dec|not_dec)|FunctionalExtensionality.functional_extensionality_dep|Classical_Prop.classic'

scripts=0
for script in *.g; do
  name=${script%.g}
  file=$work/$name.v
  # Gappa takes a script's rewriting hints, lines "a -> b;", as hypotheses a = b. They are identities of polynomials: ring proves
  # them, or this fails.
  gappa -Bcoq "$script" 2>"$work/$name.err" |
    sed -E 's/^Hypothesis (a[0-9]+) : (.*)\.$/Lemma \1 : \2. Proof. ring. Qed./; s/^Require Import Gappa/Require Import Reals Gappa/' >"$file" ||
    { cat "$work/$name.err" >&2; fail "$script is not proved"; }
  ! grep -nwE 'Hypothes[ie]s|Axioms?|Admitted|admit|Parameters?|Conjecture' "$file" || fail "$script: something is taken for granted"
  # l1 is what the script says: its hypotheses and the contrary of its goal are impossible, for all real values of its variables.
  echo "Print Assumptions l1." >>"$file"
  started=$SECONDS
  (cd "$work" && timeout 600 coqc -q "$name.v") >"$work/$name.log" 2>&1 || { tail -n 20 "$work/$name.log" >&2; fail "Coq does not accept the proof of $script"; }
  grep -q '^Axioms:' "$work/$name.log" || fail "$script: no answer about what it rests on"
  others=$(grep -E '^[A-Za-z_.0-9]+ *:|^[A-Za-z_.0-9]+$' "$work/$name.log" | grep -vE "^Axioms:|^($allowed)( |:|$)" || true)
  [ -z "$others" ] || fail "$script rests on $others"
  scripts=$((scripts + 1))
  printf '   %-24s accepted by Coq in %d s\n' "$script" $((SECONDS - started))
done
[ $scripts -gt 0 ] || fail "no scripts"
echo "$scripts scripts, accepted on the axioms of Coq's real numbers alone; $((SECONDS - begun)) s"
