(* SPDX-License-Identifier: Apache-2.0 *)
(* The definitions as an OCaml module: oracle.ml around it reads scenes and prints images. Integers are Zarith's; what is named
   below is taken to be what Coq defines, everything else is Coq's own text translated. *)
Require Import ZArith Extraction ExtrOcamlBasic ExtrOcamlZBigInt.
From Surefill Require Import definitions.

Extract Constant Z.sgn => "Integers.sgn".
Extract Constant Z.ltb => "Big_int_Z.lt_big_int".
Extract Constant Z.leb => "Big_int_Z.le_big_int".
Extract Constant Z.even => "Integers.even".
Extract Constant Z.log2 => "Integers.log2".
Extract Constant Z.pow => "Integers.pow".

Extraction "semantics.ml" read_vertex read_triangle index_of sample_at places render_sample values_of.
