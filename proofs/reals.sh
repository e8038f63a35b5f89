#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What is proved of real numbers, and so rests on the axioms of Coq's: that the rounding of the definitions is Flocq's, and gappa's
# proofs, every script of engine/proofs, so that gappa's word is not taken for the error bounds.
#
#     proofs/reals.sh FOLDER      after proofs/check.sh with the same folder
set -euo pipefail
work=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"
begun=$SECONDS

fail() { printf 'proofs: %s\n' "$*" >&2; exit 1; }

# The axioms of Coq's real numbers; no other is let through.
allowed='ClassicalDedekindReals.sig_(forall_dec|not_dec)|FunctionalExtensionality.functional_extensionality_dep|Classical_Prop.classic'

# accept NAME WHAT: compiles NAME.v of the current folder, which ends in Print Assumptions, and looks at what that says.
accept() {
  local name=$1 what=$2 started=$SECONDS others
  ! sed 's/(\*[^*]*\*)//g' "$name.v" | grep -nwE 'Admitted|admit|give_up|Axioms?|Conjecture|Parameters?|Hypothes[ie]s|Context|Abort' ||
    fail "$what takes something for granted"
  timeout 600 coqc -q -Q "$work" Surefill "$name.v" >"$name.log" 2>&1 || { tail -n 20 "$name.log" >&2; fail "Coq does not accept $what"; }
  grep -q '^Axioms:' "$name.log" || fail "$what: no answer about what it rests on"
  # Each axiom starts a line with its name; its statement may go on below, indented.
  others=$(grep -vE '^ |^Axioms:' "$name.log" | grep -vE "^($allowed)( |:|$)" || true)
  [ -z "$others" ] || fail "$what rests on $others"
  printf '   %-24s accepted in %d s\n' "$what" $((SECONDS - started))
}

{ cat flocq.v; sed -nE 's/^Theorem ([A-Za-z0-9_]+).*/Print Assumptions \1./p' flocq.v; } >"$work/flocq.v"
rm -rf "$work/gappa"
mkdir "$work/gappa"
scripts=0
for script in ../engine/proofs/*.g; do
  name=$(basename "$script" .g)
  # Gappa takes a script's rewriting hints, lines "a -> b;", as hypotheses a = b. They are identities of polynomials: ring proves
  # them, or Coq does not accept the file. l1 is what the script says: its hypotheses and the contrary of its goal are impossible,
  # whatever the real values of its variables.
  { gappa -Bcoq "$script" 2>"$work/gappa/$name.err" || { cat "$work/gappa/$name.err" >&2; fail "gappa does not prove $script"; }; } |
    sed -E 's/^Hypothesis (a[0-9]+) : (.*)\.$/Lemma \1 : \2. Proof. ring. Qed./; s/^Require Import Gappa/Require Import Reals Gappa/' \
      >"$work/gappa/$name.v"
  echo "Print Assumptions l1." >>"$work/gappa/$name.v"
  scripts=$((scripts + 1))
done
[ -f "../engine/proofs/$name.g" ] || fail "no scripts"

../engine/proofs/constants.sh

cd "$work"
accept flocq flocq.v
cd gappa
for file in *.v; do accept "${file%.v}" "${file%.v}.g"; done
echo "flocq.v and $scripts scripts of gappa, accepted on the axioms of Coq's real numbers alone; $((SECONDS - begun)) s"
