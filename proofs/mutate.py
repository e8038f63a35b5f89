#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Breaks the definitions of proofs/definitions.v one at a time, a sign, a strictness, an order, a number, and sees that a proof
fails, or that the program extracted from them differs from the engine and the oracles.

    proofs/mutate.py COMPARE [--quick] [--scenes N] [NAME ...]

COMPARE is the program surefill_compare_proofs. --quick: no proofs for mutants that the comparison tells. Exit status 1 if a
mutant survives both.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
THEORIES = re.search(r'^theories="(.*)"', (HERE / "check.sh").read_text(), re.M)[1].split()

# Name, text as it stands (once) in definitions.v, what it becomes.
MUTANTS = [
    ("S4 2 samples", "[(12, 12); (4, 4)]", "[(4, 4); (12, 12)]"),
    ("S4 4 samples", "[(6, 2); (14, 6);", "[(6, 2); (14, 5);"),
    ("S4 8 samples", "(11, 15); (15, 1)]", "(15, 11); (15, 1)]"),
    ("S4 16 samples", "(14, 15); (1, 0)]", "(14, 15); (0, 1)]"),
    ("S4 1 sample", "else [(8, 8)]", "else [(8, 7)]"),
    ("S4 x and y", "V (16 * i + fst place) (16 * j + snd place) 16", "V (16 * i + snd place) (16 * j + fst place) 16"),
    ("M1 centre", "sample_at i j (8, 8)", "sample_at i j (8, 9)"),
    ("E a, sign", "vy u * vw v - vw u * vy v", "vy u * vw v + vw u * vy v"),
    ("E b, order", "vw u * vx v - vx u * vw v", "vx u * vw v - vw u * vx v"),
    ("E c, component", "vx u * vy v - vy u * vx v", "vx u * vy v - vy u * vy v"),
    ("E without w", "+ ec u v * vw p", "+ ec u v"),
    ("E sign of b", "+ eb u v * vy p", "- eb u v * vy p"),
    ("D, order", "Definition D (t : tri) := let '(m0, m1, m2) := t in det m0 m1 m2", "Definition D (t : tri) := let '(m0, m1, m2) := t in det m1 m0 m2"),
    ("E0, order", "let '(_, m1, m2) := t in det m1 m2 p", "let '(_, m1, m2) := t in det m2 m1 p"),
    ("E1, order", "let '(m0, _, m2) := t in det m2 m0 p", "let '(m0, _, m2) := t in det m0 m2 p"),
    ("E2, order", "let '(m0, m1, _) := t in det m0 m1 p", "let '(m0, m1, _) := t in det m1 m0 p"),
    ("sum E, sign", "E0 t p + E1 t p + E2 t p.", "E0 t p + E1 t p - E2 t p."),
    ("C3 shift x of one rule", "top_right | bottom_right | southwards_west | northwards_west => -1", "bottom_right | southwards_west | northwards_west => -1"),
    ("C3 shift x, all", "northwards_west => -1 | _ => 1 end.\nDefinition shift_y", "northwards_west => 1 | _ => -1 end.\nDefinition shift_y"),
    ("C3 shift y of one rule", "bottom_left | bottom_right | northwards | northwards_west => -1", "bottom_left | northwards | northwards_west => -1"),
    ("C3 dominance", "bottom_left | bottom_right => true | _ => false", "bottom_left => true | _ => false"),
    ("C3 first tie, sign", "then shift_x r * ea u v else shift_y r * eb u v", "then - shift_x r * ea u v else shift_y r * eb u v"),
    ("C3 first tie, coefficient", "then shift_x r * ea u v else shift_y r * eb u v", "then shift_x r * eb u v else shift_y r * ea u v"),
    ("C3 first tie, always x", "then shift_x r * ea u v else shift_y r * eb u v", "then shift_x r * ea u v else shift_x r * ea u v"),
    ("C3 second tie, sign", "then shift_y r * eb u v else shift_x r * ea u v", "then shift_y r * eb u v else - shift_x r * ea u v"),
    ("C3 second tie, as first", "then shift_y r * eb u v else shift_x r * ea u v", "then shift_x r * ea u v else shift_y r * eb u v"),
    ("C3 ties, order", "if f =? 0 then Z.sgn g else Z.sgn f", "if g =? 0 then Z.sgn f else Z.sgn g"),
    ("C3 ties never decided", "if f =? 0 then Z.sgn g else Z.sgn f", "0"),
    ("C3 ties before the sign", "if e =? 0 then (if f =? 0 then Z.sgn g else Z.sgn f) else Z.sgn e", "if f =? 0 then (if e =? 0 then Z.sgn g else Z.sgn e) else Z.sgn f"),
    ("C1 left out", "negb (d =? 0) && (edge_sign", "(edge_sign"),
    ("C2 one edge left out", " && (edge_sign r m2 m0 p =? d)", ""),
    ("C2 edge turned", "(edge_sign r m1 m2 p =? d)", "(edge_sign r m2 m1 p =? d)"),
    ("C2 opposite sign", "let d := Z.sgn (D t) in\n  negb", "let d := - Z.sgn (D t) in\n  negb"),
    ("C2 either sign", "(edge_sign r m0 m1 p =? d).", "(negb (edge_sign r m0 m1 p =? 0))."),
    ("C5 closed, strict", "(0 <=? E1 t p * d)", "(0 <? E1 t p * d)"),
    ("C5 closed, sign of D", "(0 <=? E0 t p * d)", "(0 <=? E0 t p)"),
    ("C5 closed, degenerate", "| closed => negb (d =? 0) && ", "| closed => "),
    ("C5 open, not strict", "(0 <? E2 t p * d)", "(0 <=? E2 t p * d)"),
    ("C5 open, one edge left out", " && (0 <? E1 t p * d)", ""),
    ("F1 facing", "if counter_clockwise then D t <? 0 else 0 <? D t", "if counter_clockwise then 0 <? D t else D t <? 0"),
    ("F2 culling", "| cull_front => is_front counter_clockwise t", "| cull_front => negb (is_front counter_clockwise t)"),
    ("I1 fraction, sign", "(- n, - d) else (n, d)", "(n, - d) else (n, d)"),
    ("I1 vertices", "z1 * E1 t p + z2 * E2 t p) (D t", "z2 * E1 t p + z1 * E2 t p) (D t"),
    ("I1 without w", "+ z2 * E2 t p) (D t * vw p)", "+ z2 * E2 t p) (D t)"),
    ("I2 perspective over D", "u2 * E2 t p) (sumE t p)", "u2 * E2 t p) (D t)"),
    ("I2 perspective, vertices", "fraction (u0 * E0 t p + u1 * E1 t p + u2 * E2 t p)", "fraction (u0 * E0 t p + u2 * E1 t p + u1 * E2 t p)"),
    ("I2 noperspective, W", "u1 * vw m1 * E1 t p", "u1 * vw m0 * E1 t p"),
    ("I2 noperspective over sum", "vw m2 * E2 t p) (D t * vw p)", "vw m2 * E2 t p) (sumE t p)"),
    ("I2 flat", "| flat => (u0, 1)", "| flat => (u1, 1)"),
    ("I3 one", "Definition one := 2 ^ 149", "Definition one := 2 ^ 148"),
    ("I3 order", "[attribute_at perspective t one 0 0 p; attribute_at perspective t 0 one 0 p;", "[attribute_at perspective t 0 one 0 p; attribute_at perspective t one 0 0 p;"),
    ("I4 ties to odd", "if Z.even q then q else q + 1", "if Z.even q then q + 1 else q"),
    ("I4 ties away", "if Z.even q then q else q + 1", "q + 1"),
    ("I4 truncated", "| Gt => q + 1", "| Gt => q"),
    ("I4 23 bits", "Z.log2 (n / d) - 23", "Z.log2 (n / d) - 22"),
    ("I4 25 bits", "Z.log2 (n / d) - 23", "Z.log2 (n / d) - 24"),
    ("I4 no subnormals", "Z.max 0 (Z.log2", "Z.max 1 (Z.log2"),
    ("I4 largest", "(2 ^ 24 - 1) * 2 ^ 253", "(2 ^ 24 - 1) * 2 ^ 252"),
    ("I4 beyond largest", "(2 ^ 24 - 1) * 2 ^ 253", "2 ^ 24 * 2 ^ 253"),
    ("I4 sign", "in if n <? 0 then - k else k", "in k"),
    ("B1 NaN", "if e =? 255 then None", "if e =? 256 then None"),
    ("float32 subnormals", "if e =? 0 then m else (2 ^ 23 + m)", "if e =? 0 then 0 else (2 ^ 23 + m)"),
    ("float32 exponent", "(2 ^ 23 + m) * 2 ^ (e - 1)", "(2 ^ 23 + m) * 2 ^ e"),
    ("float32 sign", "Some (if bits <? 2 ^ 31 then k else - k)", "Some (if bits <=? 2 ^ 31 then - k else k)"),
    ("encode sign", "(if k <? 0 then 2 ^ 31 else 0) + ", "(if k <=? 0 then 2 ^ 31 else 0) + "),
    ("encode exponent", "s * 2 ^ 23 + a / 2 ^ s", "(s + 1) * 2 ^ 23 + a / 2 ^ s"),
    ("encode subnormals", "if a <? 2 ^ 23 then a", "if a <? 2 ^ 22 then a"),
    ("S3 beyond range", "if largest <? nearest_unbounded", "if largest <=? nearest_unbounded"),
    ("S3 half", "nearest_ieee n (2 ^ 150)", "nearest_ieee n (2 ^ 149)"),
    ("S3 y up", "if y_down v then y else - y", "if y_down v then - y else y"),
    ("S3 x0", "w * (2 * v_x v + v_width v)", "w * (v_x v + v_width v)"),
    ("S3 depth range", "(v_far v + v_near v)", "(v_far v - v_near v)"),
    ("S3 depth 0..1", "2 * (z * (v_far v - v_near v) + w * v_near v)", "2 * (z * (v_far v - v_near v) + w * v_far v)"),
    ("V1 sign of infinity", "then infinity else minus_infinity) else nan", "then minus_infinity else infinity) else nan"),
    ("V1 NaN", "| nan => false", "| nan => true"),
    ("V1 infinity beaten", "| infinity => negb greater", "| infinity => greater"),
    ("V1 -infinity beaten", "| minus_infinity => greater", "| minus_infinity => true"),
    ("V1 initial, strict", "else k <? k'", "else k <=? k'"),
    ("V1 initial, GREATER strict", "if greater then k' <? k", "if greater then k' <=? k"),
    ("V2 index order", "(index (source f) <? index (source g)) ||", "(index (source g) <? index (source f)) ||"),
    ("V2 position, strict", "(position (source f) <? position (source g))", "(position (source f) <=? position (source g))"),
    ("V2 position order", "(position (source f) <? position (source g))", "(position (source g) <? position (source f))"),
    ("V2 without position", "&& (position (source f) <? position (source g))", "&& false"),
    ("V1 depth, not strict", "else depth f <? depth g) ||", "else depth f <=? depth g) ||"),
    ("V1 GREATER", "if greater then depth g <? depth f", "if greater then depth f <? depth g"),
    ("V1 ties of depth", "((depth f =? depth g) && before f g)", "((depth f =? depth g) && before g f)"),
    ("M5 order", "bool := before g f.", "bool := before f g."),
    ("V1 worst", "if better f g then Some f else best", "if better f g then best else Some f"),
    ("I5 near", "if (0 <=? n) && (n <=? d)", "if (0 <? n) && (n <=? d)"),
    ("I5 far", "if (0 <=? n) && (n <=? d)", "if (0 <=? n) && (n <? d)"),
    ("I5 clamp", "if d <? n then one else", "if d <? n then 0 else"),
    ("M3 left", "(x0 <=? i)", "(x0 <? i)"),
    ("M3 right", "(i <? x1)", "(i <=? x1)"),
    ("M3 rows", "(y0 <=? j) && (j <? y1)", "(y0 <? j) && (j <=? y1)"),
    ("M2 scissor", "in_scissor (scissor d) i j && covers_by", "covers_by"),
    ("M2 culling", " && negb (is_culled (cull d) (counter_clockwise d) (shape t))", ""),
    ("V1 empty depth", "if greater then 4286578688 else 2139095040", "2139095040"),
    ("V3 initial depth ignored", "filter (fun f => beats greater (depth f) (stored_of_bits (bits old))) fragments", "filter (fun _ => true) fragments"),
    ("M2 counts what passes", "Z.of_nat (length fragments) in", "Z.of_nat (length passing) in"),
    ("V3 counts", "let count' := count old +", "let count' := 0 * count old +"),
    ("M5 as V1", "best_of (if depth_write d then nearer greater else later)", "best_of (nearer greater)"),
    ("M5 writes", "(if depth_write d then encode (depth f) else bits old)", "(encode (depth f))"),
    ("V3 order of draws", "fold_left (draw_sample greater i j p) draws", "fold_left (draw_sample greater i j p) (rev draws)"),
    ("M1 centre, sign of sum", "(Z.sgn (sumE t c) =? Z.sgn (D t))", "(0 <? Z.sgn (sumE t c))"),
    ("M1 centroid as centre", "if (negb centroid && (Z.sgn", "if (true && (Z.sgn"),
    ("M1 centre if covered", " || covers_by r t c then c", " then c"),
    ("M1 first covered", "find (covers_by r t) (map (sample_at i j) (places samples))", "find (covers_by r t) (rev (map (sample_at i j) (places samples)))"),
    ("V1 empty values", "None => map (fun _ => 0)", "None => map (fun _ => 1)"),
    ("V2 first index", "None => first_index + position", "None => position"),
]


def run(command, folder, seconds=300):
    try:
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None


def failing_proof(folder):
    """The lemma or theorem at which the first theory that does not compile stops, or None."""
    for theory in THEORIES:
        result = run(["coqc", "-q", "-Q", ".", "Surefill", theory + ".v"], folder)
        if result is not None and result.returncode == 0:
            continue
        line = re.search(r"line (\d+)", result.stderr) if result else None
        if line is None:
            return theory
        before = (folder / (theory + ".v")).read_text().splitlines()[: int(line[1])]
        names = re.findall(r"^(?:Lemma|Theorem|Definition) (\w+)", "\n".join(before), re.M)
        return f"{theory}.{names[-1]}" if names else theory
    return None


def differs(folder, compare, scenes):
    """What the comparison found, or None."""
    # Definitions and extraction in one file: most of the time goes into loading Coq's library.
    extraction = (HERE / "extract.v").read_text().replace("From Surefill Require Import definitions.\n", "")
    (folder / "mutant.v").write_text((folder / "definitions.v").read_text() + extraction)
    if run(["coqc", "-q", "mutant.v"], folder).returncode:
        sys.exit("mutate: the mutant does not compile")
    (folder / "semantics.mli").unlink()
    files = ["integers.ml", "semantics.ml", "oracle.ml"]
    if run(["ocamlfind", "ocamlopt", "-package", "zarith", "-linkpkg", *files, "-o", "oracle"], folder).returncode:
        sys.exit("mutate: the extracted program does not compile")
    for what in (["--scenes", str(scenes)], ["--corpus", str(HERE.parent / "corpus/cases")]):
        result = run([compare, "./oracle", *what], folder)
        if result is None:
            return "no answer"
        if result.returncode == 2:
            return result.stderr.strip()
        if result.returncode:
            scene = re.search(r"(\d+) scenes", result.stdout)[1]
            return f"random scene {scene} differs" if what[0] == "--scenes" else "the corpus differs"
    return None


def main():
    arguments = sys.argv[1:]
    if not arguments:
        sys.exit(__doc__)
    quick = "--quick" in arguments
    scenes = 3000
    if "--scenes" in arguments:
        scenes = int(arguments.pop(arguments.index("--scenes") + 1))
    compare, *names = [a for a in arguments if not a.startswith("--")]
    tools = tempfile.TemporaryDirectory()
    compare = shutil.copy(compare, tools.name)  # whatever is built meanwhile
    text = (HERE / "definitions.v").read_text()
    for name, old, _ in MUTANTS:
        if text.count(old) != 1:
            sys.exit(f"mutate: {name}: {text.count(old)} places in definitions.v read {old!r}")
    by_proof = by_comparison = 0
    survivors = []
    chosen = [m for m in MUTANTS if not names or m[0] in names]
    for name, old, new in chosen:
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            for source in [*HERE.glob("*.v"), *HERE.glob("*.ml")]:
                shutil.copy(source, folder)
            (folder / "definitions.v").write_text(text.replace(old, new))
            found = differs(folder, compare, scenes)
            proof = None if quick and found else failing_proof(folder)
        by_proof += proof is not None
        by_comparison += found is not None
        if proof is None and found is None:
            survivors.append(name)
        skipped = "not asked" if quick and found else "none fails"
        print(f"{name:28} proof: {proof or skipped:34} comparison: {found or 'equal'}", flush=True)
    print(f"{len(chosen)} mutants: {by_comparison} found by the comparison, {by_proof} by a proof, {len(survivors)} by neither")
    if survivors:
        sys.exit("mutate: survived: " + ", ".join(survivors))


if __name__ == "__main__":
    main()
