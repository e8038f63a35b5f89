(* SPDX-License-Identifier: Apache-2.0 *)
(* Functions of Coq's Z by Zarith, where translating Coq's own would recurse bit by bit. extract.v names them. *)
let sgn x = Z.of_int (Z.sign x)
let even = Z.is_even
let log2 x = if Z.sign x <= 0 then Z.zero else Z.of_int (Z.numbits x - 1)
let pow x y = if Z.sign y < 0 then Z.zero else Z.pow x (Z.to_int y)
