(* SPDX-License-Identifier: Apache-2.0 *)
(* What docs/semantics.md says, over the integers: every definition here names its rule, theorems are proved of these definitions,
   and these definitions run, extracted to OCaml.

   Numbers. A finite float32 is an integer times 2^-149, and stands here as that integer. A real number is a fraction of two
   integers. Sample positions are in 1/16 pixel (S4), as vectors (x, y, w) with w > 0 that stand for (x/w, y/w). *)
Require Import ZArith List Bool.
Import ListNotations.
Open Scope Z_scope.

(* ------------------------------------------------------------------------------------------------ 1. Space *)

(* S2: m = (X, Y, W). *)
Record vec := V { vx : Z; vy : Z; vw : Z }.

(* S4. Places in a pixel, in 1/16 pixel from its top left corner. *)
Definition places (samples : Z) : list (Z * Z) :=
  if samples =? 2 then [(12, 12); (4, 4)]
  else if samples =? 4 then [(6, 2); (14, 6); (2, 10); (10, 14)]
  else if samples =? 8 then [(9, 5); (7, 11); (13, 9); (5, 3); (3, 13); (1, 7); (11, 15); (15, 1)]
  else if samples =? 16 then
    [(9, 9); (7, 5); (5, 10); (12, 7); (3, 6); (10, 13); (13, 11); (11, 3); (6, 14); (8, 1); (4, 2); (2, 12); (0, 8); (15, 4);
     (14, 15); (1, 0)]
  else [(8, 8)].
Definition sample_at (i j : Z) (place : Z * Z) : vec := V (16 * i + fst place) (16 * j + snd place) 16.
Definition centre (i j : Z) : vec := sample_at i j (8, 8).

(* --------------------------------------------------------------------------------------------- 2. Coverage *)

(* E_i(p) = det(m_j, m_k, p) = a px + b py + c pw, with m_j = u and m_k = v. *)
Definition ea (u v : vec) := vy u * vw v - vw u * vy v.
Definition eb (u v : vec) := vw u * vx v - vx u * vw v.
Definition ec (u v : vec) := vx u * vy v - vy u * vx v.
Definition det (u v p : vec) := ea u v * vx p + eb u v * vy p + ec u v * vw p.

Definition tri := (vec * vec * vec)%type.
Definition D (t : tri) := let '(m0, m1, m2) := t in det m0 m1 m2.
Definition E0 (t : tri) p := let '(_, m1, m2) := t in det m1 m2 p.
Definition E1 (t : tri) p := let '(m0, _, m2) := t in det m2 m0 p.
Definition E2 (t : tri) p := let '(m0, m1, _) := t in det m0 m1 p.
Definition sumE t p := E0 t p + E1 t p + E2 t p.

(* C3: a fill rule is the sign of each shift, and which of them dominates. *)
Inductive fill_rule := top_left | top_right | bottom_left | bottom_right
                     | southwards | southwards_west | northwards | northwards_west.
Definition shift_x (r : fill_rule) : Z :=
  match r with top_right | bottom_right | southwards_west | northwards_west => -1 | _ => 1 end.
Definition shift_y (r : fill_rule) : Z :=
  match r with bottom_left | bottom_right | northwards | northwards_west => -1 | _ => 1 end.
Definition x_dominates (r : fill_rule) : bool :=
  match r with top_left | top_right | bottom_left | bottom_right => true | _ => false end.

(* C3: the coefficient that decides a tie, times its shift, and the one that decides where that is 0. *)
Definition tie1 (r : fill_rule) u v := if x_dominates r then shift_x r * ea u v else shift_y r * eb u v.
Definition tie2 (r : fill_rule) u v := if x_dominates r then shift_y r * eb u v else shift_x r * ea u v.
(* The sign of the first that is not 0. *)
Definition lex (e f g : Z) : Z := if e =? 0 then (if f =? 0 then Z.sgn g else Z.sgn f) else Z.sgn e.
(* C2, C3: the sign of the edge function of edge u v at p, ties decided. *)
Definition edge_sign (r : fill_rule) (u v p : vec) : Z := lex (det u v p) (tie1 r u v) (tie2 r u v).

(* C1, C2. *)
Definition covers (r : fill_rule) (t : tri) (p : vec) : bool :=
  let '(m0, m1, m2) := t in
  let d := Z.sgn (D t) in
  negb (d =? 0) && (edge_sign r m1 m2 p =? d) && (edge_sign r m2 m0 p =? d) && (edge_sign r m0 m1 p =? d).

(* C5: two more fill rules, of p itself. *)
Inductive coverage_rule := by_rule (r : fill_rule) | closed | open.
Definition covers_by (c : coverage_rule) (t : tri) (p : vec) : bool :=
  let d := D t in
  match c with
  | by_rule r => covers r t p
  | closed => negb (d =? 0) && (0 <=? E0 t p * d) && (0 <=? E1 t p * d) && (0 <=? E2 t p * d)
  | open => negb (d =? 0) && (0 <? E0 t p * d) && (0 <? E1 t p * d) && (0 <? E2 t p * d)
  end.

(* ------------------------------------------------------------------------------------------- 3. Facing, culling *)

Inductive culling := cull_none | cull_front | cull_back.
(* F1. *)
Definition is_front (counter_clockwise : bool) (t : tri) : bool := if counter_clockwise then D t <? 0 else 0 <? D t.
(* F2; a degenerate triangle covers nothing (C1). *)
Definition is_culled (c : culling) (counter_clockwise : bool) (t : tri) : bool :=
  match c with
  | cull_none => false
  | cull_front => is_front counter_clockwise t
  | cull_back => negb (is_front counter_clockwise t)
  end.

(* ------------------------------------------------------------------------------- 4. Depth, attributes, rounding *)

(* A fraction with a positive denominator. *)
Definition fraction (n d : Z) : Z * Z := if d <? 0 then (- n, - d) else (n, d).

(* I1: sum Z_i E_i / D. The E_i of p = (x, y, w) are w times those of (x/w, y/w, 1). *)
Definition depth_at (t : tri) (z0 z1 z2 : Z) (p : vec) : Z * Z :=
  fraction (z0 * E0 t p + z1 * E1 t p + z2 * E2 t p) (D t * vw p).

Inductive interpolation := perspective | noperspective | flat.
(* I2, in units of 2^-149. Noperspective: u_i and W_i have this unit, so that the sum over D has it too. *)
Definition attribute_at (how : interpolation) (t : tri) (u0 u1 u2 : Z) (p : vec) : Z * Z :=
  match how with
  | perspective => fraction (u0 * E0 t p + u1 * E1 t p + u2 * E2 t p) (sumE t p)
  | noperspective =>
      let '(m0, m1, m2) := t in
      fraction (u0 * vw m0 * E0 t p + u1 * vw m1 * E1 t p + u2 * vw m2 * E2 t p) (D t * vw p)
  | flat => (u0, 1)
  end.
(* I3: I2 of the unit vectors; 1 is 2^149 units. *)
Definition one := 2 ^ 149.
Definition barycentrics_at (t : tri) (p : vec) : list (Z * Z) :=
  [attribute_at perspective t one 0 0 p; attribute_at perspective t 0 one 0 p; attribute_at perspective t 0 0 one p].

(* I4. The integer nearest to n/d, d > 0, ties to even. *)
Definition nearest_integer (n d : Z) : Z :=
  let q := n / d in
  match 2 * (n mod d) ?= d with
  | Lt => q
  | Gt => q + 1
  | Eq => if Z.even q then q else q + 1
  end.
(* The float32 nearest to n/d units, n >= 0, of any exponent: 24 bits, and no bit below 2^-149. *)
Definition nearest_unbounded (n d : Z) : Z :=
  let s := Z.max 0 (Z.log2 (n / d) - 23) in nearest_integer n (d * 2 ^ s) * 2 ^ s.
Definition largest := (2 ^ 24 - 1) * 2 ^ 253.
(* I4: the nearest finite float32. *)
Definition nearest (n d : Z) : Z :=
  let k := Z.min largest (nearest_unbounded (Z.abs n) d) in if n <? 0 then - k else k.

(* IEEE 754's encoding of float32, and B1: a NaN or an infinity is no number. *)
Definition decode (bits : Z) : option Z :=
  let e := (bits / 2 ^ 23) mod 2 ^ 8 in
  let m := bits mod 2 ^ 23 in
  let k := if e =? 0 then m else (2 ^ 23 + m) * 2 ^ (e - 1) in
  if e =? 255 then None else Some (if bits <? 2 ^ 31 then k else - k).
Definition encode (k : Z) : Z :=
  let a := Z.abs k in
  let s := Z.log2 a - 23 in
  (if k <? 0 then 2 ^ 31 else 0) + (if a <? 2 ^ 23 then a else s * 2 ^ 23 + a / 2 ^ s).

(* S3, of four finite numbers; None where a result is beyond range, for then the triangle is dropped (B1). Two factors
   have the unit 2^-298, and the halves of the rule 2^-1. *)
Record viewport := Viewport { v_x : Z; v_y : Z; v_width : Z; v_height : Z; v_near : Z; v_far : Z; minus_one : bool; y_down : bool }.
Definition nearest_ieee (n d : Z) : option Z :=
  if largest <? nearest_unbounded (Z.abs n) d then None else Some (nearest n d).
Definition to_pixel (v : viewport) (x y z w : Z) : option (Z * Z * Z * Z) :=
  let half n := nearest_ieee n (2 ^ 150) in
  let y' := if y_down v then y else - y in
  let z2 := if minus_one v then z * (v_far v - v_near v) + w * (v_far v + v_near v)
            else 2 * (z * (v_far v - v_near v) + w * v_near v) in
  match half (x * v_width v + w * (2 * v_x v + v_width v)), half (y' * v_height v + w * (2 * v_y v + v_height v)), half z2 with
  | Some x', Some y'', Some z' => Some (x', y'', z', w)
  | _, _, _ => None
  end.

(* ------------------------------------------------------------------------------------------------ 5. Visibility *)

Record vertex := Vertex { pos : vec; height : Z; values : list Z }.
(* V2: `index` is the identifier, or the position and the first index; `position` is the place in the draw. *)
Record triangle := Triangle { c0 : vertex; c1 : vertex; c2 : vertex; index : Z; position : Z }.
Definition shape (t : triangle) : tri := (pos (c0 t), pos (c1 t), pos (c2 t)).

Inductive depth_mode := depth_none | depth_clip | depth_clamp.
Record draw := Draw { rule : coverage_rule; counter_clockwise : bool; cull : culling; mode : depth_mode; depth_write : bool;
                      scissor : option (Z * Z * Z * Z); triangles : list triangle }.

(* V1: what a sample may hold as depth; initial depth may be anything. *)
Inductive stored := nan | minus_infinity | finite (k : Z) | infinity.
Definition stored_of_bits (bits : Z) : stored :=
  match decode bits with
  | Some k => finite k
  | None => if bits mod 2 ^ 23 =? 0 then (if bits <? 2 ^ 31 then infinity else minus_infinity) else nan
  end.
(* V1: does a fragment of this depth beat it strictly? *)
Definition beats (greater : bool) (k : Z) (s : stored) : bool :=
  match s with
  | nan => false
  | minus_infinity => greater
  | infinity => negb greater
  | finite k' => if greater then k' <? k else k <? k'
  end.

(* A fragment: the triangle and its depth as stored. *)
Record fragment := Fragment { depth : Z; source : triangle }.

(* V1, V2: (depth, index, position), depth the other way round with GREATER. *)
Definition before (f g : fragment) : bool :=
  (index (source f) <? index (source g)) ||
  ((index (source f) =? index (source g)) && (position (source f) <? position (source g))).
Definition nearer (greater : bool) (f g : fragment) : bool :=
  (if greater then depth g <? depth f else depth f <? depth g) || ((depth f =? depth g) && before f g).
(* M5: the last one in index order. *)
Definition later (f g : fragment) : bool := before g f.
(* The best of a list. *)
Definition pick (better : fragment -> fragment -> bool) (best : option fragment) (f : fragment) : option fragment :=
  match best with Some g => if better f g then Some f else best | None => Some f end.
Definition best_of better (l : list fragment) : option fragment := fold_left (pick better) l None.

(* I5, and I4: depth as stored, or nothing where it is clipped. *)
Definition depth_of (m : depth_mode) (nd : Z * Z) : option Z :=
  let (n, d) := nd in
  match m with
  | depth_none => Some (nearest (n * one) d)
  | depth_clip => if (0 <=? n) && (n <=? d) then Some (nearest (n * one) d) else None
  | depth_clamp => Some (if n <? 0 then 0 else if d <? n then one else nearest (n * one) d)
  end.

(* M3. *)
Definition in_scissor (s : option (Z * Z * Z * Z)) (i j : Z) : bool :=
  match s with Some (x0, y0, x1, y1) => (x0 <=? i) && (i <? x1) && (y0 <=? j) && (j <? y1) | None => true end.

(* M2: the fragments of a draw at sample p of pixel (i, j). *)
Definition fragment_of (d : draw) (i j : Z) (p : vec) (t : triangle) : option fragment :=
  if in_scissor (scissor d) i j && covers_by (rule d) (shape t) p && negb (is_culled (cull d) (counter_clockwise d) (shape t)) then
    match depth_of (mode d) (depth_at (shape t) (height (c0 t)) (height (c1 t)) (height (c2 t)) p) with
    | Some k => Some (Fragment k t)
    | None => None
    end
  else None.
Fixpoint fragments_of d i j p (l : list triangle) : list fragment :=
  match l with
  | [] => []
  | t :: l => match fragment_of d i j p t with Some f => f :: fragments_of d i j p l | None => fragments_of d i j p l end
  end.

(* A sample of the image so far: count, the visible triangle with its draw's fill rule, depth as bits. *)
Record sample := Sample { count : Z; visible : option (coverage_rule * triangle); bits : Z }.
(* V1: an empty sample; without initial depth it is +inf, or -inf for GREATER. *)
Definition no_depth (greater : bool) : Z := if greater then 4286578688 else 2139095040.
Definition empty (greater : bool) (initial : option Z) : sample :=
  Sample 0 None (match initial with Some b => b | None => no_depth greater end).

(* What a draw's fragments at a sample leave: V1, V3, M2, M5. *)
Definition resolve (greater : bool) (d : draw) (old : sample) (fragments : list fragment) : sample :=
  let passing := filter (fun f => beats greater (depth f) (stored_of_bits (bits old))) fragments in
  let count' := count old + Z.of_nat (length fragments) in
  match best_of (if depth_write d then nearer greater else later) passing with
  | Some f => Sample count' (Some (rule d, source f)) (if depth_write d then encode (depth f) else bits old)
  | None => Sample count' (visible old) (bits old)
  end.
Definition draw_sample (greater : bool) (i j : Z) (p : vec) (old : sample) (d : draw) : sample :=
  resolve greater d old (fragments_of d i j p (triangles d)).
(* V3: draws in turn. *)
Definition render_sample (greater : bool) (initial : option Z) (draws : list draw) (i j : Z) (p : vec) : sample :=
  fold_left (draw_sample greater i j p) draws (empty greater initial).

(* M1: where the attributes of a triangle are evaluated in a pixel. *)
Definition value_place (centroid : bool) (samples : Z) (r : coverage_rule) (t : tri) (i j : Z) : vec :=
  let c := centre i j in
  if (negb centroid && (Z.sgn (sumE t c) =? Z.sgn (D t))) || covers_by r t c then c
  else match find (covers_by r t) (map (sample_at i j) (places samples)) with Some p => p | None => c end.

Fixpoint attributes_at (how : list interpolation) (t : tri) (u0 u1 u2 : list Z) (p : vec) : list (Z * Z) :=
  match how, u0, u1, u2 with
  | h :: how, a :: u0, b :: u1, c :: u2 => attribute_at h t a b c p :: attributes_at how t u0 u1 u2 p
  | _, _, _, _ => []
  end.
(* Barycentrics, then attributes, as stored; `how` has one entry for each float of a vertex. *)
Definition values_of (how : list interpolation) (centroid : bool) (samples i j : Z) (s : sample) : list Z :=
  match visible s with
  | Some (r, t) =>
      let p := value_place centroid samples r (shape t) i j in
      map (fun nd => encode (nearest (fst nd) (snd nd)))
        (barycentrics_at (shape t) p ++ attributes_at how (shape t) (values (c0 t)) (values (c1 t)) (values (c2 t)) p)
  | None => map (fun _ => 0) ([perspective; perspective; perspective] ++ how)
  end.

(* ------------------------------------------------------------------------------------------------- 7. Bad input *)

Fixpoint decode_all (l : list Z) : option (list Z) :=
  match l with
  | [] => Some []
  | b :: l => match decode b, decode_all l with Some k, Some ks => Some (k :: ks) | _, _ => None end
  end.
(* A vertex of x, y, z, w and its attributes, as bits; None where one is a NaN or an infinity (B1, S3). *)
Definition read_vertex (v : option viewport) (numbers : list Z) : option vertex :=
  match decode_all numbers with
  | Some (x :: y :: z :: w :: u) =>
      match v with
      | None => Some (Vertex (V x y w) z u)
      | Some v => match to_pixel v x y z w with Some (x, y, z, w) => Some (Vertex (V x y w) z u) | None => None end
      end
  | _ => None
  end.
(* V2. *)
Definition index_of (identifier : option Z) (first_index position : Z) : Z :=
  match identifier with Some i => i | None => first_index + position end.
(* B1: a triangle with such a vertex is dropped; the others keep their positions. *)
Definition read_triangle (a b c : option vertex) (index position : Z) : option triangle :=
  match a, b, c with Some a, Some b, Some c => Some (Triangle a b c index position) | _, _, _ => None end.
