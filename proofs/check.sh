#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the proofs: compiles every theory, refuses what is not proved, and prints what each theorem rests on.
#
#     proofs/check.sh FOLDER      build products go to FOLDER
set -euo pipefail
mkdir -p "$1"
work=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"

fail() { printf 'proofs: %s\n' "$*" >&2; exit 1; }
# coq FILE: compiles build products' copy of a theory; a proof that runs away is a failure.
coq() { nice timeout 600 coqc -q -Q . Surefill "$1" >"${1%.v}.log" 2>&1 || { cat "${1%.v}.log" >&2; fail "$1 does not compile"; }; }

# In the order in which they need each other.
theories="definitions coverage degree rounding values visibility"

# Nothing is taken for granted: these words never stand outside comments.
for theory in $theories; do
  ! sed 's/(\*[^*]*\*)//g' "$theory.v" | grep -nwE 'Admitted|admit|give_up|Axiom|Axioms|Conjecture|Parameter|Parameters|Hypothesis|Hypotheses|Variable|Variables|Context|Abort' ||
    fail "$theory.v takes something for granted"
done

for theory in $theories; do
  cmp -s "$theory.v" "$work/$theory.v" || cp "$theory.v" "$work/"
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

# What each theorem rests on, asked of Coq.
{
  echo "From Surefill Require Import $theories."
  for theory in $theories; do
    sed -nE 's/^Theorem ([A-Za-z0-9_]+).*/\1/p' "$theory.v" | sed -E "s/(.*)/Check \"$theory.\1\"%string. Print Assumptions $theory.\1./"
  done
} | sed '1a Require Import String.' >assumptions.v
coq assumptions.v
awk '/^"/ { name = $1; next } /^ +: string$/ { next } NF { print name ": " $0 }' assumptions.log | sed 's/["]//g; s/%string//' >assumptions.txt
theorems=$(grep -c 'Check' assumptions.v)
[ "$theorems" -gt 0 ] || fail "no theorems"
cat assumptions.txt
[ "$(wc -l <assumptions.txt)" = "$theorems" ] || fail "not every theorem was asked for what it rests on"
! grep -v ': Closed under the global context$' assumptions.txt || fail "a theorem rests on an assumption"
echo "$theorems theorems, none rests on an axiom"
