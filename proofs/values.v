(* SPDX-License-Identifier: Apache-2.0 *)
(* Depth and attributes: I3's weights, I4's ranges, I5, and what T4 and T5 say of values. *)
Require Import ZArith Lia List Bool.
From Surefill Require Import definitions coverage rounding.
Import ListNotations.
Open Scope Z_scope.

(* The E_i at a covered sample, with the sign of D taken out: none is negative, and one is positive. *)
Definition weights (t : tri) p := let s := Z.sgn (D t) in (s * E0 t p, s * E1 t p, s * E2 t p).

Lemma covered_weights r t p : 0 < vw p -> covers_by r t p = true ->
  let '(a, b, c) := weights t p in 0 <= a /\ 0 <= b /\ 0 <= c /\ 0 < a + b + c /\ D t <> 0.
Proof.
  intros W C. destruct (covers_by_cone r t p C) as [HD K]. destruct t as [[m0 m1] m2].
  apply (cone_closed _ _ HD) in K. pose proof (cone_identity m0 m1 m2 p) as I. cbn zeta in I.
  unfold weights. set (t := (m0, m1, m2)) in *. set (d := D t) in *.
  assert (S : forall e, 0 <= e * d -> 0 <= Z.sgn d * e) by
    (intros e; destruct (sgn_cases d) as [[? ->]|[[? ->]|[? ->]]]; nia).
  destruct K as (A & B & K). apply S in A, B, K. repeat split; try assumption.
  assert (N : E0 t p <> 0 \/ E1 t p <> 0 \/ E2 t p <> 0).
  { destruct (Z.eq_dec (E0 t p) 0) as [X|]; [|auto]. destruct (Z.eq_dec (E1 t p) 0) as [Y|]; [|auto].
    destruct (Z.eq_dec (E2 t p) 0) as [Z'|]; [|auto]. exfalso. rewrite X, Y, Z' in I.
    unfold scale, plus in I; cbn [vx vy vw] in I. injection I as _ _ Iw.
    assert (d * vw p = 0) by (rewrite Iw; ring). apply Z.mul_eq_0 in H. destruct H; lia. }
  destruct (sgn_unit d HD) as [G|G]; rewrite G in *; lia.
Qed.

(* A fraction over a number of the sign s. *)
Lemma fraction_sign n d s : (s = 1 \/ s = -1) -> 0 < s * d -> fraction n d = (s * n, s * d).
Proof. intros [-> | ->] H; unfold fraction; destruct (Z.ltb_spec d 0); f_equal; lia. Qed.
Lemma fraction_positive n d : d <> 0 -> 0 < snd (fraction n d).
Proof. unfold fraction. destruct (Z.ltb_spec d 0); cbn; lia. Qed.

(* The depth of a triangle that covers anything is a number. *)
Lemma depth_number r t z0 z1 z2 p : 0 < vw p -> covers_by r t p = true -> 0 < snd (depth_at t z0 z1 z2 p).
Proof.
  intros W C. pose proof (covered_weights r t p W C) as H. unfold weights in H. cbn in H.
  apply fraction_positive. nia.
Qed.

(* I2 of a perspective attribute, as a mean with weights that are not negative. *)
Lemma perspective_mean r t u0 u1 u2 p : 0 < vw p -> covers_by r t p = true ->
  let '(a, b, c) := weights t p in attribute_at perspective t u0 u1 u2 p = (u0 * a + u1 * b + u2 * c, a + b + c).
Proof.
  intros W C. pose proof (covered_weights r t p W C) as H. unfold weights in *. cbn zeta in *. cbn [attribute_at].
  destruct H as (A & B & K & S & HD). rewrite (fraction_sign _ _ (Z.sgn (D t)) (sgn_unit _ HD)); unfold sumE; [f_equal; ring|lia].
Qed.

(* I3: at a covered sample the barycentrics are in 0..1 and add up to 1, as real numbers. *)
Theorem I3_weights r t p : 0 < vw p -> covers_by r t p = true -> exists n0 n1 n2 d,
  barycentrics_at t p = [(n0, d); (n1, d); (n2, d)] /\ 0 < d /\
  0 <= n0 <= one * d /\ 0 <= n1 <= one * d /\ 0 <= n2 <= one * d /\ n0 + n1 + n2 = one * d.
Proof.
  intros W C. pose proof (covered_weights r t p W C) as H.
  pose proof (perspective_mean r t one 0 0 p W C) as M0. pose proof (perspective_mean r t 0 one 0 p W C) as M1.
  pose proof (perspective_mean r t 0 0 one p W C) as M2.
  destruct (weights t p) as [[a b] c]. unfold barycentrics_at. rewrite M0, M1, M2.
  assert (0 < one) by reflexivity.
  do 4 eexists. split; [reflexivity|]. repeat split; try nia.
Qed.

(* I4: a perspective attribute stays in every range of float32 that holds its three values. *)
Theorem I4_perspective r t u0 u1 u2 lo hi p : 0 < vw p -> covers_by r t p = true -> representable lo -> representable hi ->
  lo <= u0 <= hi -> lo <= u1 <= hi -> lo <= u2 <= hi ->
  let '(n, d) := attribute_at perspective t u0 u1 u2 p in lo <= nearest n d <= hi.
Proof.
  intros W C L H U0 U1 U2. pose proof (covered_weights r t p W C) as K. pose proof (perspective_mean r t u0 u1 u2 p W C) as M.
  destruct (weights t p) as [[a b] c]. rewrite M. apply nearest_range; try assumption; [tauto|]. split; nia.
Qed.
(* I4: a constant attribute is constant to the bit. *)
Theorem I4_constant r t u p : 0 < vw p -> covers_by r t p = true -> representable u ->
  let '(n, d) := attribute_at perspective t u u u p in nearest n d = u.
Proof.
  intros W C R. pose proof (I4_perspective r t u u u u u p W C R R ltac:(lia) ltac:(lia) ltac:(lia)) as H.
  destruct (attribute_at perspective t u u u p). lia.
Qed.
Theorem I4_flat t u0 u1 u2 p : representable u0 -> let '(n, d) := attribute_at flat t u0 u1 u2 p in nearest n d = u0.
Proof. intros R. cbn. rewrite <- (Z.mul_1_r u0) at 1. now apply nearest_exact. Qed.
(* I3 and I4: barycentrics as stored are in 0..1. *)
Theorem I4_barycentrics r t p : 0 < vw p -> covers_by r t p = true ->
  Forall (fun nd => 0 <= nearest (fst nd) (snd nd) <= one) (barycentrics_at t p).
Proof.
  intros W C. destruct (I3_weights r t p W C) as (n0 & n1 & n2 & d & -> & Hd & A & B & K & _).
  assert (representable 0) by (exists 0, 0; split; [lia|]; split; [lia|reflexivity]).
  assert (representable one) by (exists 1, 149; split; [lia|]; split; [lia|reflexivity]).
  apply Forall_forall. intros nd [<-|[<-|[<-|[]]]]; cbn [fst snd]; apply nearest_range; auto; lia.
Qed.

(* I5: depth as stored is in 0..1 where it is clipped or clamped, and is one float32 in every mode. *)
Theorem I5_depth m n d k : 0 < d -> depth_of m (n, d) = Some k -> representable k /\ (m <> depth_none -> 0 <= k <= one).
Proof.
  intros Hd.
  assert (Z0 : representable 0) by (exists 0, 0; split; [lia|]; split; [lia|reflexivity]).
  assert (O : representable one) by (exists 1, 149; split; [lia|]; split; [lia|reflexivity]).
  assert (R : representable (nearest (n * one) d)) by now apply nearest_correct.
  assert (I : 0 <= n -> n <= d -> 0 <= nearest (n * one) d <= one)
    by (intros; apply nearest_range; auto; assert (0 < one) by reflexivity; nia).
  destruct m; cbn.
  - injection 1 as <-. split; [exact R|congruence].
  - destruct (Z.leb_spec 0 n), (Z.leb_spec n d); cbn; try discriminate. injection 1 as <-. auto.
  - injection 1 as <-. destruct (Z.ltb_spec n 0); [split; [exact Z0|intros; unfold one; lia]|].
    destruct (Z.ltb_spec d n); [split; [exact O|intros; unfold one; lia]|auto].
Qed.

(* ------------------------------------------------------------------------------------------------- T4, T5: values *)

(* Two fractions are the same number. *)
Definition same (a b : Z * Z) := fst a * snd b = fst b * snd a.
Lemma same_nearest a b : 0 < snd a -> 0 < snd b -> same a b -> nearest (fst a) (snd a) = nearest (fst b) (snd b).
Proof. intros. now apply nearest_well_defined. Qed.
Lemma fraction_same n d n' d' : n * d' = n' * d -> same (fraction n d) (fraction n' d').
Proof. intros. unfold same, fraction. destruct (Z.ltb_spec d 0), (Z.ltb_spec d' 0); cbn; lia. Qed.

(* T4: with Z scaled as its vertex is, depth stays the same number. *)
Theorem T4_depth a b c p i j k z0 z1 z2 :
  same (depth_at (scale i a, scale j b, scale k c) (i * z0) (j * z1) (k * z2) p) (depth_at (a, b, c) z0 z1 z2 p).
Proof.
  unfold depth_at. apply fraction_same. unfold D, E0, E1, E2, scale, det, ea, eb, ec; cbn [vx vy vw]. ring.
Qed.
(* T5: depth and attributes do not depend on the order of the vertices. *)
Theorem T5_depth_cyclic a b c p z0 z1 z2 : depth_at (b, c, a) z1 z2 z0 p = depth_at (a, b, c) z0 z1 z2 p.
Proof. unfold depth_at. f_equal; unfold D, E0, E1, E2, det, ea, eb, ec; ring. Qed.
Theorem T5_depth_swap a b c p z0 z1 z2 : same (depth_at (a, c, b) z0 z2 z1 p) (depth_at (a, b, c) z0 z1 z2 p).
Proof. unfold depth_at. apply fraction_same. unfold D, E0, E1, E2, det, ea, eb, ec; ring. Qed.
Theorem T5_attribute_cyclic how a b c p u0 u1 u2 : how <> flat ->
  attribute_at how (b, c, a) u1 u2 u0 p = attribute_at how (a, b, c) u0 u1 u2 p.
Proof.
  destruct how; intros; try congruence; cbn [attribute_at]; f_equal; unfold sumE, D, E0, E1, E2, det, ea, eb, ec; ring.
Qed.
Theorem T5_attribute_swap how a b c p u0 u1 u2 : how <> flat ->
  same (attribute_at how (a, c, b) u0 u2 u1 p) (attribute_at how (a, b, c) u0 u1 u2 p).
Proof.
  destruct how; intros; try congruence; cbn [attribute_at]; apply fraction_same; unfold sumE, D, E0, E1, E2, det, ea, eb, ec; ring.
Qed.

(* ------------------------------------------------------------------------------------------------ M1: the place *)

(* The triangle covers its centroid place, so that I3 and I4 hold there. `p` is the sample at which it is visible. *)
Theorem M1_centroid samples r t i j place : In place (places samples) -> covers_by r t (sample_at i j place) = true ->
  covers_by r t (value_place true samples r t i j) = true.
Proof.
  intros I C. unfold value_place. cbn [negb andb orb]. destruct (covers_by r t (centre i j)) eqn:E; [exact E|].
  destruct (find (covers_by r t) (map (sample_at i j) (places samples))) as [q|] eqn:F; [now apply find_some in F|].
  pose proof (find_none _ _ F (sample_at i j place) (in_map _ _ _ I)). congruence.
Qed.
(* With one sample a pixel it is the sample itself. *)
Theorem M1_one_sample centroid r t i j : covers_by r t (centre i j) = true -> value_place centroid 1 r t i j = centre i j.
Proof. intros C. unfold value_place. rewrite C, orb_true_r. reflexivity. Qed.

(* --------------------------------------------------------------------------------------------------- S3: range *)

(* What S3 stores is a float32, the nearest one; a float32 is kept, the largest too. *)
Theorem S3_nearest n d k : 0 < d -> nearest_ieee n d = Some k -> representable k /\ k = nearest n d.
Proof.
  intros Hd. unfold nearest_ieee. destruct (_ <? _); [discriminate|]. injection 1 as <-.
  split; [now apply nearest_correct|reflexivity].
Qed.
Theorem S3_exact k d : 0 < d -> representable k -> nearest_ieee (k * d) d = Some k.
Proof.
  intros Hd R. unfold nearest_ieee. rewrite (nearest_exact k d Hd R).
  destruct (Z.ltb_spec largest (nearest_unbounded (Z.abs (k * d)) d)) as [L|]; [exfalso|reflexivity].
  (* Else the unbounded one would be farther from |k| than |k| itself. *)
  assert (A : Z.abs (k * d) = Z.abs k * d) by (rewrite Z.abs_mul, (Z.abs_eq d); lia).
  destruct (unbounded_form (Z.abs (k * d)) d ltac:(lia) Hd) as (m & s & _ & _ & E & _ & N).
  rewrite E in L. pose proof (representable_bound k R) as B.
  assert (R' : representable (Z.abs k)) by (destruct (Z.abs_spec k) as [[_ ->]|[_ ->]]; [exact R|now apply representable_opp]).
  destruct (N (Z.abs k) (representable_like _ R')) as [X _]. rewrite A in X.
  replace (Z.abs k * d - d * Z.abs k) with 0 in X by ring. assert (d * (m * 2 ^ s) = d * Z.abs k) by lia. nia.
Qed.
