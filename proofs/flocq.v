(* SPDX-License-Identifier: Apache-2.0 *)
(* I4's rounding is that of Flocq, the formal library of floating-point arithmetic: to nearest, ties to even, in float32's format.
   Unlike the other theories this one speaks of Coq's real numbers, and rests on their axioms. *)
Require Import ZArith Reals Lia Lra.
From Flocq Require Import Core.
From Surefill Require Import definitions rounding.
Open Scope R_scope.

Local Instance precision : Prec_gt_0 24 := eq_refl.
Local Instance valid : Valid_exp (FLT_exp (-149) 24) := FLT_exp_valid (-149) 24.
Local Instance even : Exists_NE radix2 (FLT_exp (-149) 24) := exists_NE_FLT radix2 (-149) 24 (or_intror eq_refl).
Notation format := (generic_format radix2 (FLT_exp (-149) 24)).

(* The real number that k units are. *)
Definition value (k : Z) : R := IZR k * bpow radix2 (-149).

Lemma IZR_pow s : (0 <= s)%Z -> IZR (2 ^ s) = bpow radix2 s.
Proof. intros. rewrite <- (IZR_Zpower radix2) by assumption. reflexivity. Qed.
Lemma value_float m s : (0 <= s)%Z -> value (m * 2 ^ s) = F2R (Float radix2 m (s - 149)).
Proof.
  intros S. unfold value, F2R; cbn [Fnum Fexp]. rewrite mult_IZR, IZR_pow by assumption.
  rewrite Rmult_assoc, <- bpow_plus. do 2 f_equal.
Qed.
Lemma float_like_format k : float_like k -> format (value k).
Proof.
  intros (m & s & M & S & ->). rewrite value_float by assumption. apply generic_format_FLT.
  exists (Float radix2 m (s - 149)); [reflexivity|exact M|cbn; lia].
Qed.
Lemma format_float_like x : format x -> exists k, float_like k /\ x = value k.
Proof.
  intros F. apply FLT_format_generic in F; [|exact precision]. destruct F as [[m e] -> M E]. cbn in M, E.
  exists (m * 2 ^ (e + 149))%Z. split.
  - exists m, (e + 149)%Z. split; [exact M|]. split; [lia|reflexivity].
  - rewrite value_float by lia. do 2 f_equal. lia.
Qed.

(* Distances from n/d, in integers and in reals. *)
Definition real (n d : Z) : R := IZR n / IZR d * bpow radix2 (-149).
Lemma distance n d k : (0 < d)%Z -> Rabs (value k - real n d) = IZR (Z.abs (n - d * k)) * (bpow radix2 (-149) / IZR d).
Proof.
  intros Hd. assert (D : 0 < IZR d) by now apply IZR_lt. pose proof (bpow_gt_0 radix2 (-149)) as U.
  rewrite abs_IZR, minus_IZR, mult_IZR. unfold value, real.
  replace (IZR k * bpow radix2 (-149) - IZR n / IZR d * bpow radix2 (-149))
    with (- ((IZR n - IZR d * IZR k) * (bpow radix2 (-149) / IZR d))) by (field; lra).
  rewrite Rabs_Ropp, Rabs_mult. f_equal. apply Rabs_pos_eq. apply Rlt_le, Rdiv_lt_0_compat; assumption.
Qed.
Lemma distance_le n d k l : (0 < d)%Z ->
  Rabs (value k - real n d) <= Rabs (value l - real n d) <-> (Z.abs (n - d * k) <= Z.abs (n - d * l))%Z.
Proof.
  intros Hd. assert (D : 0 < IZR d) by now apply IZR_lt. pose proof (bpow_gt_0 radix2 (-149)) as U.
  rewrite !distance by assumption. assert (0 < bpow radix2 (-149) / IZR d) by now apply Rdiv_lt_0_compat. split.
  - intros L. apply le_IZR. now apply Rmult_le_reg_r with (bpow radix2 (-149) / IZR d).
  - intros L. apply Rmult_le_compat_r; [lra|]. now apply IZR_le.
Qed.

Lemma canonical_float m s : (Z.abs m < 2 ^ 24)%Z -> (0 <= s)%Z -> (s = 0 \/ 2 ^ 23 <= Z.abs m)%Z -> m <> 0%Z ->
  canonical radix2 (FLT_exp (-149) 24) (Float radix2 m (s - 149)).
Proof.
  intros M S C N. unfold canonical, cexp. cbn [Fexp]. rewrite mag_F2R by assumption. unfold FLT_exp.
  assert (B : Rabs (IZR m) < bpow radix2 24).
  { rewrite <- abs_IZR, <- IZR_pow by lia. now apply IZR_lt. }
  destruct C as [->|C].
  - assert (mag radix2 (IZR m) <= 24)%Z by (apply mag_le_bpow; [now apply IZR_neq|exact B]). lia.
  - rewrite (mag_unique radix2 (IZR m) 24); [lia|]. split; [|exact B].
    rewrite <- abs_IZR. change (24 - 1)%Z with 23%Z. rewrite <- IZR_pow by lia. now apply IZR_le.
Qed.

Lemma unbounded_round n d : (0 <= n)%Z -> (0 < d)%Z ->
  value (nearest_unbounded n d) = round radix2 (FLT_exp (-149) 24) ZnearestE (real n d).
Proof.
  intros Hn Hd. apply (round_unique (Rnd_NE_pt radix2 (FLT_exp (-149) 24))) with (real n d);
    [apply Rnd_NE_pt_monotone; typeclasses eauto| |apply round_NE_pt; typeclasses eauto].
  destruct (unbounded_form n d Hn Hd) as (m & s & M & S & -> & C & N).
  assert (near : Rnd_N_pt format (real n d) (value (m * 2 ^ s))).
  { split.
    - apply float_like_format. exists m, s. split; [lia|]. split; [lia|reflexivity].
    - intros g G. destruct (format_float_like g G) as (k & K & ->). apply distance_le; [assumption|]. now apply N. }
  split; [exact near|]. destruct (Z.Even_or_Odd m) as [E|O].
  - left. destruct (Z.eq_dec m 0) as [->|NZ].
    + exists (Float radix2 0 (FLT_exp (-149) 24 (mag radix2 0))). rewrite Z.mul_0_l. split; [|split].
      * unfold value. rewrite F2R_0. ring.
      * apply canonical_0.
      * reflexivity.
    + exists (Float radix2 m (s - 149)). split; [now apply value_float|]. split.
      * apply canonical_float; auto; [lia|]. destruct C; [left|right]; lia.
      * cbn. now apply Z.even_spec.
  - right. intros f [F B]. destruct (format_float_like f F) as (k & K & ->).
    destruct (N k K) as [L T]. specialize (B _ (proj1 near)). apply distance_le in B; [|assumption].
    destruct T as [->|X]; [lia|reflexivity|]. exfalso. destruct X as [x ->], O as [y O]. lia.
Qed.

(* Within range `nearest` is Flocq's rounding of the real number; beyond it, I4 stores the largest finite value. *)
Theorem nearest_flocq n d : (0 < d)%Z -> (nearest_unbounded (Z.abs n) d <= largest)%Z ->
  value (nearest n d) = round radix2 (FLT_exp (-149) 24) ZnearestE (real n d).
Proof.
  intros Hd L. unfold nearest. rewrite Z.min_r by assumption.
  assert (V : value (- nearest_unbounded (Z.abs n) d) = - value (nearest_unbounded (Z.abs n) d))
    by (unfold value; rewrite opp_IZR; ring).
  assert (A : n = Z.abs n \/ (n < 0 /\ n = - Z.abs n)%Z) by lia.
  destruct (Z.ltb_spec n 0).
  - rewrite V, unbounded_round by lia. rewrite <- round_NE_opp. f_equal. unfold real.
    replace (IZR n) with (- IZR (Z.abs n)) by (rewrite <- opp_IZR; f_equal; lia).
    assert (0 < IZR d) by now apply IZR_lt. field. lra.
  - rewrite unbounded_round by lia. f_equal. f_equal. lia.
Qed.
