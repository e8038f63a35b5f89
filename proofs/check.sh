#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the proofs: compiles every theory, refuses what is not proved, prints what each theorem rests on, and holds the
# program extracted from the definitions against the engine and both oracles.
#
#     proofs/check.sh FOLDER COMPARE SCENES      build products go to FOLDER; COMPARE is the program surefill_compare_proofs
set -euo pipefail
mkdir -p "$1"
work=$(cd "$1" && pwd)
compare=$(realpath "$2")
scenes=$3
cd "$(dirname "${BASH_SOURCE[0]}")"
corpus=$(cd ../corpus/cases && pwd)
begun=$SECONDS

fail() { printf 'proofs: %s\n' "$*" >&2; exit 1; }
# coq FILE: compiles a theory; a proof that runs away is a failure.
coq() { timeout 600 coqc -q -Q . Surefill "$1" >"${1%.v}.log" 2>&1 || { cat "${1%.v}.log" >&2; fail "$1 does not compile"; }; }

# In the order in which they need each other.
theories="definitions coverage degree rounding values visibility"
sources="$theories extract"

# Nothing is taken for granted: these words never stand outside comments.
for theory in $sources; do
  ! sed 's/(\*[^*]*\*)//g' "$theory.v" | grep -nwE 'Admitted|admit|give_up|Axioms?|Conjecture|Parameters?|Hypothes[ie]s|Variables?|Context|Abort' ||
    fail "$theory.v takes something for granted"
done

for file in $(printf '%s.v ' $sources) integers.ml oracle.ml; do
  cmp -s "$file" "$work/$file" || cp "$file" "$work/"
done
cd "$work"
stale=
for theory in $theories; do
  [ -z "$stale" ] && [ "$theory.vo" -nt "$theory.v" ] && continue
  stale=yes
  started=$SECONDS
  coq "$theory.v"
  printf '   %-12s compiled in %d s\n' "$theory" $((SECONDS - started))
done

# What the theorems rest on, asked of Coq: of all at once, as that takes seconds, and of each only if the answer is not "nothing".
theorems=$(for theory in $theories; do sed -nE "s/^Theorem ([A-Za-z0-9_]+).*/$theory.\1/p" "$theory.v"; done)
[ -n "$theorems" ] || fail "no theorems"
{
  echo "From Surefill Require Import $theories."
  echo "Definition all := ($(printf '@%s, ' $theorems)tt)."
  echo "Print Assumptions all."
} >assumptions.v
coq assumptions.v
printf '   %s\n' $theorems
if [ "$(cat assumptions.log)" != "Closed under the global context" ]; then
  { echo "From Surefill Require Import $theories."; printf 'Print Assumptions %s.\n' $theorems; } >each.v
  coq each.v
  cat each.log >&2
  fail "a theorem rests on an assumption"
fi
echo "$(wc -w <<<"$theorems") theorems, all \"closed under the global context\": none rests on an axiom; checked in $((SECONDS - begun)) s"

# The definitions as a program.
begun=$SECONDS
coq extract.v
rm -f semantics.mli
ocamlfind ocamlopt -package zarith -linkpkg integers.ml semantics.ml oracle.ml -o oracle >oracle.log 2>&1 ||
  { cat oracle.log >&2; fail "the extracted program does not compile"; }
"$compare" ./oracle --corpus "$corpus" --scenes "$scenes"
echo "extracted and compared in $((SECONDS - begun)) s"
