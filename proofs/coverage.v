(* SPDX-License-Identifier: Apache-2.0 *)
(* Theorems about coverage: the cone, T1, T3, T4, T5, and what C3's infinitely small step means. *)
Require Import ZArith Lia List Bool.
From Surefill Require Import definitions.
Import ListNotations.
Open Scope Z_scope.

Definition scale (k : Z) (u : vec) := V (k * vx u) (k * vy u) (k * vw u).
Definition plus (u v : vec) := V (vx u + vx v) (vy u + vy v) (vw u + vw v).
Definition neg (u : vec) := scale (-1) u.
Definition zero := V 0 0 0.

Lemma shift_x_unit r : shift_x r * shift_x r = 1.
Proof. destruct r; reflexivity. Qed.
Lemma shift_y_unit r : shift_y r * shift_y r = 1.
Proof. destruct r; reflexivity. Qed.

Lemma sgn_cases n : (n < 0 /\ Z.sgn n = -1) \/ (n = 0 /\ Z.sgn n = 0) \/ (0 < n /\ Z.sgn n = 1).
Proof. destruct n; cbn; lia. Qed.

Lemma lex_scale k e f g : lex (k * e) (k * f) (k * g) = Z.sgn k * lex e f g.
Proof.
  unfold lex.
  destruct (Z.eqb_spec (k * e) 0), (Z.eqb_spec (k * f) 0), (Z.eqb_spec e 0), (Z.eqb_spec f 0);
    rewrite ?Z.sgn_mul; subst; try nia;
    destruct (sgn_cases k) as [[? ?]|[[? ?]|[? ?]]]; nia.
Qed.

Lemma det_cyc u v w : det u v w = det v w u.
Proof. unfold det, ea, eb, ec; ring. Qed.
Lemma det_swap u v w : det v u w = - det u v w.
Proof. unfold det, ea, eb, ec; ring. Qed.

Lemma edge_scale r k l u v p : edge_sign r (scale k u) (scale l v) p = Z.sgn (k * l) * edge_sign r u v p.
Proof.
  unfold edge_sign. rewrite <- lex_scale. f_equal; unfold tie1, tie2, det, ea, eb, ec;
  cbn; try destruct (x_dominates r); ring.
Qed.

(* The edge term is antisymmetric: the key to T1 and T2. *)
Theorem edge_swap r u v p : edge_sign r v u p = - edge_sign r u v p.
Proof.
  replace (- edge_sign r u v p) with (Z.sgn (-1) * edge_sign r u v p) by (change (Z.sgn (-1)) with (-1); ring).
  unfold edge_sign. rewrite <- lex_scale.
  f_equal; unfold tie1, tie2, det, ea, eb, ec; try destruct (x_dominates r); ring.
Qed.

(* ------------------------------------------------------------------------------------------------------ Cone *)

(* p = (E_0 m_0 + E_1 m_1 + E_2 m_2) / D. *)
Theorem cone_identity m0 m1 m2 p :
  let t := (m0, m1, m2) in
  scale (D t) p = plus (scale (E0 t p) m0) (plus (scale (E1 t p) m1) (scale (E2 t p) m2)).
Proof. unfold scale, plus, D, E0, E1, E2, det, ea, eb, ec; cbn. f_equal; ring. Qed.

(* The weights are unique: of k p = l0 m0 + l1 m1 + l2 m2, l_i / k is E_i / D. *)
Theorem cone_weights m0 m1 m2 p k l0 l1 l2 :
  let t := (m0, m1, m2) in
  scale k p = plus (scale l0 m0) (plus (scale l1 m1) (scale l2 m2)) ->
  k * E0 t p = l0 * D t /\ k * E1 t p = l1 * D t /\ k * E2 t p = l2 * D t.
Proof.
  unfold scale, plus, D, E0, E1, E2, det, ea, eb, ec; cbn. injection 1 as X Y W. split; [|split].
  - transitivity ((vy m1 * vw m2 - vw m1 * vy m2) * (k * vx p) + (vw m1 * vx m2 - vx m1 * vw m2) * (k * vy p)
      + (vx m1 * vy m2 - vy m1 * vx m2) * (k * vw p)); [ring|]. rewrite X, Y, W; ring.
  - transitivity ((vy m2 * vw m0 - vw m2 * vy m0) * (k * vx p) + (vw m2 * vx m0 - vx m2 * vw m0) * (k * vy p)
      + (vx m2 * vy m0 - vy m2 * vx m0) * (k * vw p)); [ring|]. rewrite X, Y, W; ring.
  - transitivity ((vy m0 * vw m1 - vw m0 * vy m1) * (k * vx p) + (vw m0 * vx m1 - vx m0 * vw m1) * (k * vy p)
      + (vx m0 * vy m1 - vy m0 * vx m1) * (k * vw p)); [ring|]. rewrite X, Y, W; ring.
Qed.

(* p is in the closed cone, with rational weights, that is, seen through the triangle in front of the eye. *)
Definition in_cone (t : tri) (p : vec) := let '(m0, m1, m2) := t in
  exists k l0 l1 l2, 0 < k /\ 0 <= l0 /\ 0 <= l1 /\ 0 <= l2 /\
    scale k p = plus (scale l0 m0) (plus (scale l1 m1) (scale l2 m2)).
Definition in_open_cone (t : tri) (p : vec) := let '(m0, m1, m2) := t in
  exists k l0 l1 l2, 0 < k /\ 0 < l0 /\ 0 < l1 /\ 0 < l2 /\
    scale k p = plus (scale l0 m0) (plus (scale l1 m1) (scale l2 m2)).

Lemma cone_scaled m0 m1 m2 p : let t := (m0, m1, m2) in
  scale (D t * D t) p = plus (scale (E0 t p * D t) m0) (plus (scale (E1 t p * D t) m1) (scale (E2 t p * D t) m2)).
Proof. unfold scale, plus, D, E0, E1, E2, det, ea, eb, ec; cbn. f_equal; ring. Qed.

(* "p is seen through the triangle, in front of the eye, exactly if no E_i / D is negative." *)
Theorem cone_closed t p : D t <> 0 -> in_cone t p <-> 0 <= E0 t p * D t /\ 0 <= E1 t p * D t /\ 0 <= E2 t p * D t.
Proof.
  destruct t as [[m0 m1] m2]. intros HD. split.
  - intros (k & l0 & l1 & l2 & K & L0 & L1 & L2 & H). destruct (cone_weights _ _ _ _ _ _ _ _ H) as (A & B & C).
    set (t := (m0, m1, m2)) in *. assert (0 <= D t * D t) by nia.
    assert (S : forall e l, k * e = l * D t -> 0 <= l -> 0 <= e * D t).
    { intros e l H1 H2. assert (k * (e * D t) = l * (D t * D t)) by (rewrite Z.mul_assoc, H1; ring).
      assert (0 <= l * (D t * D t)) by nia. nia. }
    split; [|split]; eapply S; eassumption.
  - intros (A & B & C). exists (D (m0, m1, m2) * D (m0, m1, m2)). do 3 eexists.
    split; [nia|]. split; [exact A|]. split; [exact B|]. split; [exact C|]. apply cone_scaled.
Qed.
Theorem cone_open t p : D t <> 0 -> in_open_cone t p <-> 0 < E0 t p * D t /\ 0 < E1 t p * D t /\ 0 < E2 t p * D t.
Proof.
  destruct t as [[m0 m1] m2]. intros HD. split.
  - intros (k & l0 & l1 & l2 & K & L0 & L1 & L2 & H). destruct (cone_weights _ _ _ _ _ _ _ _ H) as (A & B & C).
    set (t := (m0, m1, m2)) in *. assert (0 < D t * D t) by nia.
    assert (S : forall e l, k * e = l * D t -> 0 < l -> 0 < e * D t).
    { intros e l H1 H2. assert (k * (e * D t) = l * (D t * D t)) by (rewrite Z.mul_assoc, H1; ring).
      assert (0 < l * (D t * D t)) by nia. nia. }
    split; [|split]; eapply S; eassumption.
  - intros (A & B & C). exists (D (m0, m1, m2) * D (m0, m1, m2)). do 3 eexists.
    split; [nia|]. split; [exact A|]. split; [exact B|]. split; [exact C|]. apply cone_scaled.
Qed.

(* A covered sample is in the closed cone; one in the open cone is covered, whatever the rule. *)
Lemma edge_nonneg r u v p d : d = 1 \/ d = -1 -> edge_sign r u v p = d -> 0 <= det u v p * d.
Proof.
  unfold edge_sign, lex. destruct (Z.eqb_spec (det u v p) 0) as [->|]; [intros; lia|].
  destruct (sgn_cases (det u v p)) as [[? ->]|[[? ->]|[? ->]]]; intros; nia.
Qed.
Lemma sgn_unit n : n <> 0 -> Z.sgn n = 1 \/ Z.sgn n = -1.
Proof. destruct n; cbn; auto; lia. Qed.
Lemma sgn_transfer e d : 0 <= e * Z.sgn d -> 0 <= e * d.
Proof. destruct (sgn_cases d) as [[? ->]|[[? ->]|[? ->]]]; nia. Qed.
Lemma covers_spec r m0 m1 m2 p : let d := Z.sgn (det m0 m1 m2) in
  covers r (m0, m1, m2) p = true <->
  det m0 m1 m2 <> 0 /\ edge_sign r m1 m2 p = d /\ edge_sign r m2 m0 p = d /\ edge_sign r m0 m1 p = d.
Proof.
  cbn. unfold covers. rewrite !andb_true_iff, negb_true_iff, !Z.eqb_eq, Z.eqb_neq. cbn [D]. rewrite Z.sgn_null_iff. tauto.
Qed.
Theorem covers_in_cone r t p : covers r t p = true -> in_cone t p.
Proof.
  destruct t as [[m0 m1] m2]. intros H. apply covers_spec in H as (HD & A & B & C).
  pose proof (sgn_unit _ HD) as U. apply cone_closed; [exact HD|]. cbn [E0 E1 E2 D].
  repeat split; apply sgn_transfer; eapply edge_nonneg; eauto.
Qed.
Theorem open_cone_covers r t p : D t <> 0 -> in_open_cone t p -> covers r t p = true.
Proof.
  destruct t as [[m0 m1] m2]. intros HD H. apply cone_open in H as (A & B & C); [|exact HD].
  cbn [E0 E1 E2 D] in *. apply covers_spec. unfold edge_sign, lex.
  assert (S : forall e d, 0 < e * d -> (e =? 0) = false /\ Z.sgn e = Z.sgn d).
  { intros e d ?. split; [apply Z.eqb_neq; nia|].
    destruct (sgn_cases e) as [[? ->]|[[? ->]|[? ->]]], (sgn_cases d) as [[? ->]|[[? ->]|[? ->]]]; nia. }
  destruct (S _ _ A) as [-> ->], (S _ _ B) as [-> ->], (S _ _ C) as [-> ->]. auto.
Qed.

(* C5: closed is the closed cone, open the open one, and each of the eight rules is between them. *)
Theorem C5_closed t p : covers_by closed t p = true <-> D t <> 0 /\ in_cone t p.
Proof.
  cbn [covers_by]. rewrite !andb_true_iff, negb_true_iff, Z.eqb_neq, !Z.leb_le. split.
  - intros (((HD & A) & B) & C). split; [exact HD|]. apply cone_closed; auto.
  - intros (HD & K). apply cone_closed in K; tauto.
Qed.
Theorem C5_open t p : covers_by open t p = true <-> D t <> 0 /\ in_open_cone t p.
Proof.
  cbn [covers_by]. rewrite !andb_true_iff, negb_true_iff, Z.eqb_neq, !Z.ltb_lt. split.
  - intros (((HD & A) & B) & C). split; [exact HD|]. apply cone_open; auto.
  - intros (HD & K). apply cone_open in K; tauto.
Qed.
Theorem C5_between r t p : (covers_by open t p = true -> covers r t p = true) /\ (covers r t p = true -> covers_by closed t p = true).
Proof.
  split; intros H.
  - apply C5_open in H as [HD K]. now apply open_cone_covers.
  - apply C5_closed. split; [|now apply covers_in_cone with r]. destruct t as [[m0 m1] m2]. apply covers_spec in H. tauto.
Qed.
(* Whichever rule covers p: D is not 0, and p is in the closed cone. *)
Lemma covers_by_cone c t p : covers_by c t p = true -> D t <> 0 /\ in_cone t p.
Proof.
  intros H. apply C5_closed. destruct c as [r| |]; [now apply (C5_between r)|exact H|].
  apply (C5_between top_left). now apply C5_between.
Qed.

(* --------------------------------------------------------------------------------------------------- T5. Order *)

Theorem T5_cyclic r a b c p : covers r (b, c, a) p = covers r (a, b, c) p /\ D (b, c, a) = D (a, b, c).
Proof.
  unfold covers, D. rewrite <- (det_cyc a b c). split; [|reflexivity].
  destruct (negb _), (edge_sign r b c p =? _), (edge_sign r c a p =? _), (edge_sign r a b p =? _); reflexivity.
Qed.
(* D changes its sign, and the facing with it (F1). *)
Theorem T5_swap r a b c p : covers r (a, c, b) p = covers r (a, b, c) p /\ D (a, c, b) = - D (a, b, c).
Proof.
  assert (N : det a c b = - det a b c) by (unfold det, ea, eb, ec; ring).
  split; [|exact N]. unfold covers, D. rewrite (edge_swap r b c), (edge_swap r a b), (edge_swap r c a), N, Z.sgn_opp.
  destruct (Z.eqb_spec (Z.sgn (det a b c)) 0) as [->|]; [reflexivity|].
  apply eq_true_iff_eq. rewrite !andb_true_iff, !negb_true_iff, !Z.eqb_eq, !Z.eqb_neq. lia.
Qed.

(* And of closed and open, which look at the products E_i D alone. *)
Lemma tests_and (f : Z -> bool) d x y z : negb d && f x && f y && f z = negb d && f y && f z && f x.
Proof. destruct d, (f x), (f y), (f z); reflexivity. Qed.
Lemma tests_swap (f : Z -> bool) d x y z : negb d && f x && f z && f y = negb d && f x && f y && f z.
Proof. destruct d, (f x), (f y), (f z); reflexivity. Qed.
Theorem T5_closed_open o a b c p : o = closed \/ o = open ->
  covers_by o (b, c, a) p = covers_by o (a, b, c) p /\ covers_by o (a, c, b) p = covers_by o (a, b, c) p.
Proof.
  assert (C : D (b, c, a) = D (a, b, c)) by (unfold D; now rewrite <- det_cyc).
  assert (N : D (a, c, b) = - D (a, b, c)) by (unfold D, det, ea, eb, ec; ring).
  assert (Z0 : forall d, (- d =? 0) = (d =? 0)) by (intros d; destruct (Z.eqb_spec (- d) 0), (Z.eqb_spec d 0); lia).
  assert (S0 : E0 (a, c, b) p = - E0 (a, b, c) p) by (unfold E0; apply det_swap).
  assert (S1 : E1 (a, c, b) p = - E2 (a, b, c) p) by (unfold E1, E2; apply det_swap).
  assert (S2 : E2 (a, c, b) p = - E1 (a, b, c) p) by (unfold E1, E2; apply det_swap).
  intros O. assert (T : exists f, forall t, covers_by o t p = negb (D t =? 0) && f (E0 t p * D t) && f (E1 t p * D t) && f (E2 t p * D t))
    by (destruct O as [-> | ->]; [exists (Z.leb 0)|exists (Z.ltb 0)]; reflexivity).
  destruct T as [f T]. rewrite !T, C, N, S0, S1, S2, Z0, !Z.mul_opp_opp. split; [|apply tests_swap].
  change (E0 (b, c, a) p) with (E1 (a, b, c) p). change (E1 (b, c, a) p) with (E2 (a, b, c) p).
  change (E2 (b, c, a) p) with (E0 (a, b, c) p). symmetry. apply tests_and.
Qed.

(* No double hit on a shared edge: two front-facing triangles on its two sides. *)
Theorem shared_edge r u v w x p : 0 < det u v w -> 0 < det v u x ->
  covers r (u, v, w) p = true -> covers r (v, u, x) p = true -> False.
Proof.
  intros A B H H'. apply covers_spec in H as (_ & _ & _ & H), H' as (_ & _ & _ & H').
  rewrite (edge_swap r u v) in H'. rewrite Z.sgn_pos in * by assumption. lia.
Qed.

(* ------------------------------------------------------------------------------------------------- T3. Octants *)

(* Where the edge function is not 0 everywhere, C3 leaves no tie. *)
Lemma rule_nz r a b : tie1 r a b = 0 -> tie2 r a b = 0 -> ea a b = 0 /\ eb a b = 0.
Proof.
  pose proof (shift_x_unit r). pose proof (shift_y_unit r). unfold tie1, tie2. destruct (x_dominates r); nia.
Qed.
Definition parallel u v := ea u v = 0 /\ eb u v = 0 /\ ec u v = 0.
Lemma det_parallel u v p : parallel u v -> det u v p = 0.
Proof. intros (A & B & C). unfold det. rewrite A, B, C. ring. Qed.
Lemma edge_unit r u v p : vw p <> 0 -> ~ parallel u v -> edge_sign r u v p = 1 \/ edge_sign r u v p = -1.
Proof.
  intros W H. unfold edge_sign, lex.
  destruct (Z.eqb_spec (det u v p) 0); [|now apply sgn_unit].
  destruct (Z.eqb_spec (tie1 r u v) 0); [|now apply sgn_unit].
  apply sgn_unit. intros Z2. destruct (rule_nz r u v) as [A B]; auto. apply H. split; [exact A|]. split; [exact B|].
  unfold det in *. rewrite A, B in *. nia.
Qed.
Lemma edge_nz r a b c p : vw p <> 0 -> det a b c <> 0 -> edge_sign r a b p = 1 \/ edge_sign r a b p = -1.
Proof. intros W H. apply edge_unit; auto. intros P. apply H. now apply det_parallel. Qed.

Definition unit (s : Z) := s = 1 \/ s = -1.
Lemma det_scale3 i j k a b c : det (scale i a) (scale j b) (scale k c) = i * j * k * det a b c.
Proof. unfold det, ea, eb, ec; cbn; ring. Qed.

Lemma covers_scale r a b c p i j k : covers r (scale i a, scale j b, scale k c) p = true <->
  (Z.sgn (i * j * k) * Z.sgn (det a b c) <> 0 /\ Z.sgn (j * k) * edge_sign r b c p = Z.sgn (i * j * k) * Z.sgn (det a b c)
   /\ Z.sgn (k * i) * edge_sign r c a p = Z.sgn (i * j * k) * Z.sgn (det a b c)
   /\ Z.sgn (i * j) * edge_sign r a b p = Z.sgn (i * j * k) * Z.sgn (det a b c)).
Proof.
  rewrite covers_spec, !edge_scale, det_scale3, (Z.sgn_mul (i * j * k)), <- (Z.sgn_null_iff (_ * _)), Z.sgn_mul. tauto.
Qed.

Theorem T3_octants r a b c p : vw p <> 0 -> det a b c <> 0 ->
  exists i j k, (unit i /\ unit j /\ unit k /\ covers r (scale i a, scale j b, scale k c) p = true) /\
    forall i' j' k', unit i' -> unit j' -> unit k' ->
      covers r (scale i' a, scale j' b, scale k' c) p = true -> i' = i /\ j' = j /\ k' = k.
Proof.
  intros W H.
  assert (Ha := edge_nz r b c a p W ltac:(rewrite <- det_cyc; assumption)).
  assert (Hb := edge_nz r c a b p W ltac:(rewrite <- det_cyc, <- det_cyc; assumption)).
  assert (Hc := edge_nz r a b c p W H).
  assert (Hd := sgn_unit _ H). set (d := Z.sgn (det a b c)) in *.
  exists (d * edge_sign r b c p), (d * edge_sign r c a p), (d * edge_sign r a b p). split.
  - rewrite covers_scale. fold d. unfold unit.
    destruct Ha as [-> | ->], Hb as [-> | ->], Hc as [-> | ->], Hd as [-> | ->]; cbn; lia.
  - intros i j k I J K. rewrite covers_scale. fold d.
    destruct Ha as [-> | ->], Hb as [-> | ->], Hc as [-> | ->], Hd as [-> | ->],
      I as [-> | ->], J as [-> | ->], K as [-> | ->]; cbn; lia.
Qed.

(* --------------------------------------------------------------------------------------------------- T4. Scale *)

Theorem T4_scale r a b c p i j k : 0 < i -> 0 < j -> 0 < k ->
  covers r (scale i a, scale j b, scale k c) p = covers r (a, b, c) p.
Proof.
  intros. unfold covers, D. rewrite !edge_scale, det_scale3.
  rewrite !Z.sgn_mul, !(Z.sgn_pos i), !(Z.sgn_pos j), !(Z.sgn_pos k) by assumption.
  now rewrite !Z.mul_1_l.
Qed.
(* Negative powers of two, and any ratio: vertices on the same rays from the eye. *)
Theorem T4_rays r a b c a' b' c' p i j k i' j' k' :
  0 < i -> 0 < j -> 0 < k -> 0 < i' -> 0 < j' -> 0 < k' ->
  scale i a = scale i' a' -> scale j b = scale j' b' -> scale k c = scale k' c' ->
  covers r (a, b, c) p = covers r (a', b', c') p.
Proof.
  intros. rewrite <- (T4_scale r a b c p i j k), <- (T4_scale r a' b' c' p i' j' k') by assumption. congruence.
Qed.
Theorem T4_closed_open o a b c p i j k : o = closed \/ o = open -> 0 < i -> 0 < j -> 0 < k ->
  covers_by o (scale i a, scale j b, scale k c) p = covers_by o (a, b, c) p.
Proof.
  intros O I J K. assert (X : 0 < i * j * k) by nia.
  assert (S : forall x y u v q, det (scale x u) (scale y v) q = x * y * det u v q) by (intros; unfold det, ea, eb, ec; cbn; ring).
  assert (L : forall x y, 0 < x -> (0 <=? x * y) = (0 <=? y)) by (intros x y ?; destruct (Z.leb_spec 0 (x * y)), (Z.leb_spec 0 y); nia).
  assert (M : forall x y, 0 < x -> (0 <? x * y) = (0 <? y)) by (intros x y ?; destruct (Z.ltb_spec 0 (x * y)), (Z.ltb_spec 0 y); nia).
  assert (N : forall x y, 0 < x -> (x * y =? 0) = (y =? 0)) by (intros x y ?; destruct (Z.eqb_spec (x * y) 0), (Z.eqb_spec y 0); nia).
  assert (P : forall x y e, 0 < x -> 0 < y -> x * y * e * (i * j * k * det a b c) = x * y * (i * j * k) * (e * det a b c)) by (intros; ring).
  assert (T : forall x y e, 0 < x -> 0 < y -> (0 <=? x * y * e * (i * j * k * det a b c)) = (0 <=? e * det a b c) /\
    (0 <? x * y * e * (i * j * k * det a b c)) = (0 <? e * det a b c)).
  { intros x y e A B. rewrite P by assumption. assert (0 < x * y * (i * j * k)) by (repeat apply Z.mul_pos_pos; assumption).
    split; [now apply L|now apply M]. }
  destruct (T j k (det b c p) J K) as [L0 M0], (T k i (det c a p) K I) as [L1 M1], (T i j (det a b p) I J) as [L2 M2].
  destruct O as [-> | ->]; cbn [covers_by E0 E1 E2 D]; rewrite det_scale3, !S, N by assumption;
    [rewrite L0, L1, L2|rewrite M0, M1, M2]; reflexivity.
Qed.
(* What is covered is not by the negated triangle. *)
Theorem T4_negation r a b c p : covers r (a, b, c) p = true -> covers r (neg a, neg b, neg c) p = false.
Proof.
  intros H. apply covers_spec in H as (HD & A & B & C). apply not_true_iff_false. unfold neg. rewrite covers_scale.
  rewrite A. destruct (sgn_unit _ HD) as [-> | ->]; cbn; lia.
Qed.

Theorem T4_negation_closed_open o a b c p : vw p <> 0 -> covers_by o (a, b, c) p = true -> covers_by o (neg a, neg b, neg c) p = false.
Proof.
  intros W H. apply not_true_iff_false. intros H'. apply covers_by_cone in H as [HD K], H' as [HD' K'].
  apply cone_closed in K, K'; try assumption.
  assert (X : D (neg a, neg b, neg c) = - D (a, b, c)) by (unfold D, neg; rewrite det_scale3; ring).
  assert (X0 : E0 (neg a, neg b, neg c) p = E0 (a, b, c) p) by (unfold E0, neg, scale, det, ea, eb, ec; cbn [vx vy vw]; ring).
  assert (X1 : E1 (neg a, neg b, neg c) p = E1 (a, b, c) p) by (unfold E1, neg, scale, det, ea, eb, ec; cbn [vx vy vw]; ring).
  assert (X2 : E2 (neg a, neg b, neg c) p = E2 (a, b, c) p) by (unfold E2, neg, scale, det, ea, eb, ec; cbn [vx vy vw]; ring).
  rewrite X, X0, X1, X2 in K'. pose proof (f_equal vw (cone_identity a b c p)) as I.
  unfold scale, plus in I. cbn [vw] in I. set (d := D (a, b, c)) in *.
  assert (Z0 : forall e, 0 <= e * d -> 0 <= e * - d -> e = 0).
  { intros e A B. assert (e * d = 0) as Y by lia. apply Z.mul_eq_0 in Y. tauto. }
  destruct K as (A & B & C), K' as (A' & B' & C').
  rewrite (Z0 _ A A'), (Z0 _ B B'), (Z0 _ C C') in I. assert (d * vw p = 0) as Y by lia. apply Z.mul_eq_0 in Y. tauto.
Qed.

(* ------------------------------------------------------------------------ C3: the infinitely small step is one *)

(* For each step a/b with b >= N a, that is, 0 < a/b <= 1/N. *)
Lemma lex_eventually e f g : exists N, 0 < N /\ forall a b, 0 < a -> N * a <= b -> Z.sgn (b * b * e + a * b * f + a * a * g) = lex e f g.
Proof.
  exists (1 + Z.abs f + Z.abs g). split; [lia|]. intros a b Ha Hb.
  assert (a <= b) by nia. unfold lex.
  destruct (Z.eqb_spec e 0) as [->|He]; [destruct (Z.eqb_spec f 0) as [->|Hf]|].
  - replace (b * b * 0 + a * b * 0 + a * a * g) with (a * a * g) by ring.
    rewrite !Z.sgn_mul, (Z.sgn_pos a) by lia. destruct (Z.sgn g); reflexivity.
  - replace (b * b * 0 + a * b * f + a * a * g) with (a * (b * f + a * g)) by ring.
    rewrite Z.sgn_mul, (Z.sgn_pos a), Z.mul_1_l by lia.
    assert (a * Z.abs g < b) by nia.
    destruct (sgn_cases f) as [[? ->]|[[? ?]|[? ->]]]; try lia;
      [apply Z.sgn_neg|apply Z.sgn_pos]; nia.
  - assert (X : a * (Z.abs f + Z.abs g) < b) by nia.
    assert (Y : b * (a * (Z.abs f + Z.abs g)) < b * b) by nia.
    assert (a * a * Z.abs g <= b * (a * Z.abs g)) by nia.
    assert (M : forall c z, 0 <= c -> - (c * Z.abs z) <= c * z <= c * Z.abs z) by (intros c z C; destruct (Z.abs_spec z) as [[? ->]|[? ->]]; nia).
    pose proof (M (a * b) f ltac:(nia)). pose proof (M (a * a) g ltac:(nia)).
    replace (a * b * Z.abs f) with (b * (a * Z.abs f)) in * by ring.
    assert (b * (a * (Z.abs f + Z.abs g)) = b * (a * Z.abs f) + b * (a * Z.abs g)) by ring.
    destruct (sgn_cases e) as [[? ->]|[[? ?]|[? ->]]]; try lia.
    + apply Z.sgn_neg. assert (b * b * e <= - (b * b)) by nia. lia.
    + apply Z.sgn_pos. assert (b * b <= b * b * e) by nia. lia.
Qed.

(* C3's perturbed point for e = a/b: (x/w + e, y/w + e^2) with x dominant and both shifts 1. *)
Definition perturbed (r : fill_rule) (p : vec) (a b : Z) : vec :=
  if x_dominates r
  then V (b * b * vx p + shift_x r * (a * b) * vw p) (b * b * vy p + shift_y r * (a * a) * vw p) (b * b * vw p)
  else V (b * b * vx p + shift_x r * (a * a) * vw p) (b * b * vy p + shift_y r * (a * b) * vw p) (b * b * vw p).
(* "For every small enough step." *)
Definition eventually (Q : Z -> Z -> Prop) := exists N, 0 < N /\ forall a b, 0 < a -> N * a <= b -> Q a b.
Lemma eventually_and Q R : eventually Q -> eventually R -> eventually (fun a b => Q a b /\ R a b).
Proof.
  intros (N & N0 & H) (M & M0 & H'). exists (N + M). split; [lia|]. intros a b A B. split; [apply H|apply H']; nia.
Qed.
Lemma eventually_weaken (Q R : Z -> Z -> Prop) : (forall a b, Q a b -> R a b) -> eventually Q -> eventually R.
Proof. intros I (N & N0 & H). exists N. auto. Qed.
Lemma eventually_ex Q : eventually Q -> exists a b, 0 < a /\ 0 < b /\ Q a b.
Proof. intros (N & N0 & H). exists 1, N. repeat split; try lia. apply H; lia. Qed.
Lemma perturbed_w r p a b : 0 < vw p -> b <> 0 -> 0 < vw (perturbed r p a b).
Proof. intros. unfold perturbed. destruct (x_dominates r); cbn; nia. Qed.

(* The sign that C3 gives is the sign at every perturbed point near enough. *)
Theorem C3_sign r u v p : 0 < vw p -> eventually (fun a b => Z.sgn (det u v (perturbed r p a b)) = edge_sign r u v p).
Proof.
  intros W. destruct (lex_eventually (det u v p) (vw p * tie1 r u v) (vw p * tie2 r u v)) as (N & N0 & H).
  exists N. split; [exact N0|]. intros a b A B. specialize (H a b A B).
  replace (det u v (perturbed r p a b)) with (b * b * det u v p + a * b * (vw p * tie1 r u v) + a * a * (vw p * tie2 r u v))
    by (unfold det, perturbed, tie1, tie2; destruct (x_dominates r); cbn; ring).
  rewrite H. unfold edge_sign, lex.
  destruct (Z.eqb_spec (det u v p) 0); [|reflexivity].
  destruct (Z.eqb_spec (vw p * tie1 r u v) 0), (Z.eqb_spec (tie1 r u v) 0); try nia;
  rewrite Z.sgn_mul, (Z.sgn_pos (vw p)) by assumption; apply Z.mul_1_l.
Qed.

(* Strictly inside, and off the edges: no tie is left to decide. *)
Definition inside (t : tri) (q : vec) : bool :=
  let '(m0, m1, m2) := t in let d := Z.sgn (D t) in
  negb (d =? 0) && (Z.sgn (det m1 m2 q) =? d) && (Z.sgn (det m2 m0 q) =? d) && (Z.sgn (det m0 m1 q) =? d).
Definition off_edges (t : tri) (q : vec) : Prop := D t <> 0 -> E0 t q <> 0 /\ E1 t q <> 0 /\ E2 t q <> 0.

Theorem C3_covers r t p : 0 < vw p ->
  eventually (fun a b => inside t (perturbed r p a b) = covers r t p /\ off_edges t (perturbed r p a b)).
Proof.
  intros W. destruct t as [[m0 m1] m2].
  apply (eventually_weaken (fun a b => Z.sgn (det m1 m2 (perturbed r p a b)) = edge_sign r m1 m2 p /\
    (Z.sgn (det m2 m0 (perturbed r p a b)) = edge_sign r m2 m0 p /\ Z.sgn (det m0 m1 (perturbed r p a b)) = edge_sign r m0 m1 p))).
  2: { repeat apply eventually_and; now apply C3_sign. }
  intros a b (H0 & H1 & H2). unfold inside, covers, off_edges. rewrite H0, H1, H2. split; [reflexivity|].
  cbn [D E0 E1 E2]. intros HD.
  assert (Z0 : forall z, Z.sgn z = 1 \/ Z.sgn z = -1 -> z <> 0) by (intros z [|] ->; discriminate).
  repeat split; apply Z0; rewrite ?H0, ?H1, ?H2.
  - apply edge_nz with m0; [lia|]. now rewrite <- det_cyc.
  - apply edge_nz with m1; [lia|]. now rewrite det_cyc.
  - now apply edge_nz with m2; [lia|].
Qed.

(* ----------------------------------------------------------------------------------------------- T1. Partition *)

(* A mesh that tiles a region: each point of it off all edges is strictly inside exactly one triangle (T-junctions and
   degenerate triangles allowed). Then a sample whose perturbed points lie in the region is covered exactly once. *)
Theorem T1_partition r (mesh : list tri) (region : vec -> Prop) p : 0 < vw p ->
  (forall q, 0 < vw q -> region q -> Forall (fun t => off_edges t q) mesh ->
     length (filter (fun t => inside t q) mesh) = 1%nat) ->
  eventually (fun a b => region (perturbed r p a b)) ->
  length (filter (fun t => covers r t p) mesh) = 1%nat.
Proof.
  intros W T R.
  assert (M : eventually (fun a b => Forall (fun t => off_edges t (perturbed r p a b)) mesh /\
     filter (fun t => inside t (perturbed r p a b)) mesh = filter (fun t => covers r t p) mesh)).
  { clear T R. induction mesh as [|t mesh IH].
    - exists 1. split; [lia|]. split; constructor.
    - eapply eventually_weaken; [|exact (eventually_and _ _ (C3_covers r t p W) IH)].
      intros a b ((C & O) & F & I). split; [now constructor|]. cbn. rewrite C, I. reflexivity. }
  destruct (eventually_ex _ (eventually_and _ _ R M)) as (a & b & A & B & G & F & I).
  rewrite <- I. apply T; auto. apply perturbed_w; lia.
Qed.
