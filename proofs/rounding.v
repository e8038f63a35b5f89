(* SPDX-License-Identifier: Apache-2.0 *)
(* I4: `nearest` is the finite float32 nearest to a fraction, ties to even; encoding and decoding float32. *)
Require Import ZArith Lia Bool.
From Surefill Require Import definitions.
Open Scope Z_scope.

(* The finite float32 values, in units of 2^-149. *)
Definition representable (k : Z) := exists m s, Z.abs m < 2 ^ 24 /\ 0 <= s <= 253 /\ k = m * 2 ^ s.
(* Their significand is even: 24 bits where there are so many. *)
Definition even_significand (k : Z) :=
  exists m s, Z.abs m < 2 ^ 24 /\ 0 <= s <= 253 /\ k = m * 2 ^ s /\ (s = 0 \/ 2 ^ 23 <= Z.abs m) /\ Z.Even m.

Lemma pow_pos n : 0 <= n -> 0 < 2 ^ n.
Proof. intros. apply Z.pow_pos_nonneg; lia. Qed.

(* |n/d - k| <= 1/2, and k is even where that is 1/2. *)
Lemma nearest_integer_half n d : 0 < d -> let k := nearest_integer n d in
  2 * Z.abs (n - d * k) <= d /\ (2 * Z.abs (n - d * k) = d -> Z.Even k).
Proof.
  intros Hd. unfold nearest_integer. pose proof (Z.div_mod n d ltac:(lia)) as E. pose proof (Z.mod_pos_bound n d Hd) as B.
  set (q := n / d) in *. set (r := n mod d) in *.
  assert (S : forall k, n - d * k = r + d * (q - k)) by (intros; lia).
  destruct (Z.compare_spec (2 * r) d) as [C|C|C]; [destruct (Z.even q) eqn:V|..]; cbn zeta; rewrite S.
  - replace (r + d * (q - q)) with r by ring. split; [lia|]. intros _. now apply Z.even_spec.
  - replace (r + d * (q - (q + 1))) with (r - d) by ring. split; [lia|]. intros _.
    apply Z.even_spec. rewrite Z.even_add, V. reflexivity.
  - replace (r + d * (q - q)) with r by ring. split; lia.
  - replace (r + d * (q - (q + 1))) with (r - d) by ring. split; lia.
Qed.
Lemma nearest_integer_nearest n d m : 0 < d -> let k := nearest_integer n d in
  Z.abs (n - d * k) <= Z.abs (n - d * m) /\ (Z.abs (n - d * k) = Z.abs (n - d * m) -> m = k \/ Z.Even k).
Proof.
  intros Hd k. destruct (nearest_integer_half n d Hd) as [H T]. fold k in H, T.
  destruct (Z.eq_dec m k) as [->|N]; [lia|].
  assert (X : d <= Z.abs (d * (k - m))) by (rewrite Z.abs_mul, (Z.abs_eq d) by lia; nia).
  replace (n - d * m) with (n - d * k + d * (k - m)) by ring. split; [lia|].
  intros Y. right. apply T. lia.
Qed.
Lemma nearest_integer_range n d lo hi : 0 < d -> lo * d <= n <= hi * d -> lo <= nearest_integer n d <= hi.
Proof.
  intros Hd [L H]. destruct (nearest_integer_nearest n d lo Hd) as [A _]. destruct (nearest_integer_nearest n d hi Hd) as [B _].
  cbn zeta in A, B. set (k := nearest_integer n d) in *. split; apply Z.nlt_ge; intros C.
  - assert (d * k < d * lo) by nia. lia.
  - assert (d * hi < d * k) by nia. lia.
Qed.

(* The exponent that `nearest_unbounded` takes. *)
Lemma exponent n d : 0 <= n -> 0 < d -> let s := Z.max 0 (Z.log2 (n / d) - 23) in
  0 <= s /\ n < d * 2 ^ (24 + s) /\ (s = 0 \/ d * 2 ^ (23 + s) <= n).
Proof.
  intros Hn Hd s. assert (Q : 0 <= n / d) by (apply Z.div_pos; lia).
  split; [lia|].
  assert (U : n < d * (n / d + 1)) by (pose proof (Z.div_mod n d ltac:(lia)); pose proof (Z.mod_pos_bound n d Hd); lia).
  assert (L : d * (n / d) <= n) by (apply Z.mul_div_le; lia).
  destruct (Z.eq_dec (n / d) 0) as [Z0|NZ].
  - assert (s = 0) as -> by (unfold s; rewrite Z0; reflexivity). rewrite Z0 in U. split; [|now left].
    change (2 ^ (24 + 0)) with 16777216. lia.
  - destruct (Z.log2_spec (n / d) ltac:(lia)) as [A B].
    assert (P : n / d < 2 ^ (24 + s)).
    { eapply Z.lt_le_trans; [exact B|]. apply Z.pow_le_mono_r; lia. }
    split; [nia|]. destruct (Z.eq_dec s 0) as [|S]; [now left|right].
    assert (2 ^ (23 + s) <= n / d) by (eapply Z.le_trans; [|exact A]; apply Z.pow_le_mono_r; lia).
    nia.
Qed.

(* A value with 24 bits, of any exponent. *)
Definition float_like (k : Z) := exists m s, Z.abs m < 2 ^ 24 /\ 0 <= s /\ k = m * 2 ^ s.
Lemma representable_like k : representable k -> float_like k.
Proof. intros (m & s & M & S & ->). exists m, s. repeat split; lia. Qed.

Lemma unbounded_form n d : 0 <= n -> 0 < d -> exists m s, 0 <= m < 2 ^ 24 /\ 0 <= s /\ nearest_unbounded n d = m * 2 ^ s /\
  (s = 0 \/ 2 ^ 23 <= m) /\
  forall f, float_like f -> Z.abs (n - d * (m * 2 ^ s)) <= Z.abs (n - d * f) /\
    (Z.abs (n - d * (m * 2 ^ s)) = Z.abs (n - d * f) -> f = m * 2 ^ s \/ Z.Even m).
Proof.
  intros Hn Hd. unfold nearest_unbounded. destruct (exponent n d Hn Hd) as (S & U & L). cbn zeta in *.
  set (s := Z.max 0 (Z.log2 (n / d) - 23)) in *. set (m := nearest_integer n (d * 2 ^ s)).
  pose proof (pow_pos s S) as Ps. assert (Hds : 0 < d * 2 ^ s) by nia.
  rewrite Z.pow_add_r in U by lia.
  assert (Lm : s = 0 \/ 2 ^ 23 <= m).
  { destruct L as [L|L]; [now left|right]. rewrite Z.pow_add_r in L by lia.
    apply (nearest_integer_range n (d * 2 ^ s) (2 ^ 23) (2 ^ 24) Hds). lia. }
  assert (Rm : 0 <= m <= 2 ^ 24) by (apply (nearest_integer_range n (d * 2 ^ s) 0 (2 ^ 24) Hds); lia).
  (* Nearest among all: coarser values are multiples of 2^s, finer ones lie below 2^(23 + s). *)
  assert (N : forall f, float_like f -> Z.abs (n - d * (m * 2 ^ s)) <= Z.abs (n - d * f) /\
    (Z.abs (n - d * (m * 2 ^ s)) = Z.abs (n - d * f) -> f = m * 2 ^ s \/ Z.Even m)).
  { intros f (mf & sf & Mf & Sf & ->). replace (d * (m * 2 ^ s)) with (d * 2 ^ s * m) by ring.
    destruct (Z.le_gt_cases s sf) as [C|C].
    - replace (mf * 2 ^ sf) with (mf * 2 ^ (sf - s) * 2 ^ s)
        by (rewrite <- Z.mul_assoc, <- Z.pow_add_r by lia; do 2 f_equal; lia).
      replace (d * (mf * 2 ^ (sf - s) * 2 ^ s)) with (d * 2 ^ s * (mf * 2 ^ (sf - s))) by ring.
      destruct (nearest_integer_nearest n (d * 2 ^ s) (mf * 2 ^ (sf - s)) Hds) as [A B]. fold m in A, B.
      split; [exact A|]. intros E. destruct (B E) as [X|X]; [left; now rewrite X|now right].
    - assert (L' : d * 2 ^ (23 + s) <= n) by (destruct L; lia). rewrite Z.pow_add_r in L' by lia.
      destruct (nearest_integer_nearest n (d * 2 ^ s) (2 ^ 23) Hds) as [A _]. fold m in A.
      assert (F : mf * 2 ^ sf < 2 ^ 23 * 2 ^ s).
      { apply Z.lt_le_trans with (2 ^ 24 * 2 ^ sf); [apply Z.mul_lt_mono_pos_r; [apply pow_pos|]; lia|].
        rewrite <- !Z.pow_add_r by lia. apply Z.pow_le_mono_r; lia. }
      assert (d * (mf * 2 ^ sf) < d * (2 ^ 23 * 2 ^ s)) by nia. lia. }
  destruct (Z.eq_dec m (2 ^ 24)) as [M|M].
  - exists (2 ^ 23), (s + 1). replace (2 ^ 23 * 2 ^ (s + 1)) with (m * 2 ^ s)
      by (rewrite M, Z.pow_add_r by lia; change (2 ^ 24) with (2 ^ 23 * 2 ^ 1); ring).
    repeat split; try lia; try apply N; auto. intros _. right. exists (2 ^ 22). reflexivity.
  - exists m, s. repeat split; try lia; try apply N; auto.
Qed.

Lemma nearest_opp n d : n <> 0 -> nearest (- n) d = - nearest n d.
Proof.
  intros. unfold nearest. rewrite Z.abs_opp.
  destruct (Z.ltb_spec (- n) 0), (Z.ltb_spec n 0); lia.
Qed.
Lemma nearest_zero d : 0 < d -> nearest 0 d = 0.
Proof.
  intros. unfold nearest, nearest_unbounded. cbn [Z.abs]. rewrite Z.div_0_l by lia.
  change (Z.max 0 (Z.log2 0 - 23)) with 0.
  pose proof (nearest_integer_range 0 (d * 2 ^ 0) 0 0 ltac:(lia) ltac:(lia)).
  replace (nearest_integer 0 (d * 2 ^ 0)) with 0 by lia. reflexivity.
Qed.

Lemma largest_representable : representable largest.
Proof. exists (2 ^ 24 - 1), 253. unfold largest. repeat split; try lia. Qed.
Lemma representable_bound k : representable k -> Z.abs k <= largest.
Proof.
  intros (m & s & M & S & ->). rewrite Z.abs_mul, (Z.abs_eq (2 ^ s)) by (pose proof (pow_pos s); lia).
  unfold largest. apply Z.mul_le_mono_nonneg; try lia. apply Z.pow_le_mono_r; lia.
Qed.
Lemma representable_opp k : representable k -> representable (- k).
Proof. intros (m & s & M & S & ->). exists (- m), s. rewrite Z.abs_opp. repeat split; try lia. Qed.
Lemma even_significand_opp k : even_significand k -> even_significand (- k).
Proof.
  intros (m & s & M & S & -> & C & E). exists (- m), s. rewrite Z.abs_opp. repeat split; try lia.
  destruct E as [e ->]. exists (- e). ring.
Qed.

Lemma nearest_nonneg n d : 0 <= n -> 0 < d -> let k := Z.min largest (nearest_unbounded n d) in
  representable k /\ 0 <= k /\ forall f, representable f ->
  Z.abs (n - d * k) <= Z.abs (n - d * f) /\ (Z.abs (n - d * k) = Z.abs (n - d * f) -> f = k \/ even_significand k).
Proof.
  intros Hn Hd. destruct (unbounded_form n d Hn Hd) as (m & s & M & S & E & C & N). cbn zeta. rewrite E.
  pose proof (pow_pos s S) as Ps.
  destruct (Z.le_gt_cases (m * 2 ^ s) largest) as [L|L].
  - rewrite Z.min_r by exact L.
    assert (S' : 0 <= s <= 253).
    { split; [exact S|]. destruct (Z.le_gt_cases s 253) as [|X]; [assumption|exfalso].
      assert (2 ^ 254 <= 2 ^ s) by (apply Z.pow_le_mono_r; lia).
      assert (2 ^ 23 * 2 ^ 254 <= m * 2 ^ s) by (apply Z.mul_le_mono_nonneg; lia).
      unfold largest in L. lia. }
    split; [exists m, s; repeat split; lia|]. split; [nia|]. intros f F.
    destruct (N f (representable_like f F)) as [A B]. split; [exact A|]. intros T. destruct (B T) as [X|X]; [now left|right].
    exists m, s. repeat split; try lia. exact X.
  - rewrite Z.min_l by lia. split; [exact largest_representable|]. split; [unfold largest; lia|]. intros f F.
    destruct (N largest (representable_like _ largest_representable)) as [A _].
    pose proof (representable_bound f F) as B.
    assert (d * largest < d * (m * 2 ^ s)) by nia.
    assert (d * largest <= n) by lia. assert (d * f <= d * largest) by nia.
    split; [lia|]. intros T. left. assert (d * f = d * largest) by lia. nia.
Qed.

(* I4. `nearest n d` is a finite float32, none is nearer to n/d, and of two as near it is the one of even significand. *)
Theorem nearest_correct n d : 0 < d ->
  representable (nearest n d) /\ forall f, representable f ->
  Z.abs (n - d * nearest n d) <= Z.abs (n - d * f) /\
  (Z.abs (n - d * nearest n d) = Z.abs (n - d * f) -> f = nearest n d \/ even_significand (nearest n d)).
Proof.
  intros Hd. destruct (nearest_nonneg (Z.abs n) d (Z.abs_nonneg n) Hd) as (R & P & N). cbn zeta in *.
  unfold nearest. set (k := Z.min largest (nearest_unbounded (Z.abs n) d)) in *. clearbody k.
  destruct (Z.ltb_spec n 0) as [L|L].
  - rewrite (Z.abs_neq n) in * by lia. split; [now apply representable_opp|]. intros f F.
    destruct (N (- f) (representable_opp f F)) as [A B].
    replace (n - d * - k) with (- (- n - d * k)) by ring. replace (n - d * f) with (- (- n - d * - f)) by ring.
    rewrite !Z.abs_opp. split; [exact A|]. intros T. destruct (B T) as [X|X]; [left; lia|right; now apply even_significand_opp].
  - rewrite (Z.abs_eq n) in * by lia. split; [exact R|]. exact N.
Qed.

(* Ranges: rounding never leaves what is between two float32. *)
Theorem nearest_range n d lo hi : 0 < d -> representable lo -> representable hi -> lo * d <= n <= hi * d -> lo <= nearest n d <= hi.
Proof.
  intros Hd L H [A B]. destruct (nearest_correct n d Hd) as [_ N].
  destruct (N lo L) as [NL _]. destruct (N hi H) as [NH _]. set (k := nearest n d) in *. clearbody k.
  split; apply Z.nlt_ge; intros C.
  - assert (d * k < d * lo) by nia. lia.
  - assert (d * hi < d * k) by nia. lia.
Qed.
Theorem nearest_exact k d : 0 < d -> representable k -> nearest (k * d) d = k.
Proof. intros Hd R. pose proof (nearest_range (k * d) d k k Hd R R ltac:(lia)). lia. Qed.
(* Of fractions n/d < n'/d', and of equal ones. *)
Theorem nearest_monotonic n d n' d' : 0 < d -> 0 < d' -> n * d' < n' * d -> nearest n d <= nearest n' d'.
Proof.
  intros Hd Hd' L. destruct (nearest_correct n d Hd) as [R N]. destruct (nearest_correct n' d' Hd') as [R' N'].
  destruct (N _ R') as [A _]. destruct (N' _ R) as [B _].
  set (k := nearest n d) in *. set (k' := nearest n' d') in *. clearbody k k'.
  apply Z.nlt_ge. intros C.
  (* Both are nearer to the other's result than their middle allows. *)
  assert (X : d * (k + k') <= 2 * n) by (destruct (Z.abs_spec (n - d * k)) as [[? E]|[? E]], (Z.abs_spec (n - d * k')) as [[? F]|[? F]];
    rewrite E, F in A; assert (d * k' < d * k) by nia; lia).
  assert (Y : 2 * n' <= d' * (k + k')) by (destruct (Z.abs_spec (n' - d' * k')) as [[? E]|[? E]], (Z.abs_spec (n' - d' * k)) as [[? F]|[? F]];
    rewrite E, F in B; assert (d' * k' < d' * k) by nia; lia).
  assert (d * (k + k') * d' <= 2 * n * d') by nia. assert (2 * n' * d <= d' * (k + k') * d) by nia. nia.
Qed.
Lemma nearest_integer_scale c n d : 0 < c -> 0 < d -> nearest_integer (c * n) (c * d) = nearest_integer n d.
Proof.
  intros. unfold nearest_integer. rewrite Z.div_mul_cancel_l, Z.mul_mod_distr_l by lia.
  replace (2 * (c * (n mod d))) with (c * (2 * (n mod d))) by ring.
  rewrite <- Zmult_compare_compat_l by lia. reflexivity.
Qed.
Lemma nearest_scale c n d : 0 < c -> 0 < d -> nearest (c * n) (c * d) = nearest n d.
Proof.
  intros. unfold nearest, nearest_unbounded. rewrite Z.abs_mul, (Z.abs_eq c) by lia.
  rewrite Z.div_mul_cancel_l by lia. set (s := Z.max 0 _). replace (c * d * 2 ^ s) with (c * (d * 2 ^ s)) by ring.
  rewrite nearest_integer_scale by (try apply Z.mul_pos_pos; try apply pow_pos; lia).
  replace (c * n <? 0) with (n <? 0) by (destruct (Z.ltb_spec n 0), (Z.ltb_spec (c * n) 0); nia). reflexivity.
Qed.
Theorem nearest_well_defined n d n' d' : 0 < d -> 0 < d' -> n * d' = n' * d -> nearest n d = nearest n' d'.
Proof.
  intros Hd Hd' E. rewrite <- (nearest_scale d' n d), <- (nearest_scale d n' d') by lia. f_equal; lia.
Qed.

(* -------------------------------------------------------------------------------------------------- The encoding *)

Lemma shifted m s b : 0 <= m < 2 ^ 23 -> 0 <= s < 2 ^ 8 -> 0 <= b <= 1 -> let n := b * 2 ^ 31 + s * 2 ^ 23 + m in
  (n / 2 ^ 23) mod 2 ^ 8 = s /\ n mod 2 ^ 23 = m /\ (n <? 2 ^ 31) = (b =? 0).
Proof.
  intros M S B n. assert (Q : n / 2 ^ 23 = b * 2 ^ 8 + s) by (unfold n; symmetry; apply Z.div_unique with m; lia).
  repeat split.
  - rewrite Q. symmetry. apply Z.mod_unique with b; lia.
  - unfold n. symmetry. apply Z.mod_unique with (b * 2 ^ 8 + s); lia.
  - unfold n. destruct (Z.ltb_spec (b * 2 ^ 31 + s * 2 ^ 23 + m) (2 ^ 31)), (Z.eqb_spec b 0); lia.
Qed.
Lemma decode_parts m s b : 0 <= m < 2 ^ 23 -> 0 <= s < 255 -> 0 <= b <= 1 ->
  decode (b * 2 ^ 31 + s * 2 ^ 23 + m) =
  Some (let k := if s =? 0 then m else (2 ^ 23 + m) * 2 ^ (s - 1) in if b =? 0 then k else - k).
Proof.
  intros M S B. unfold decode. destruct (shifted m s b M ltac:(lia) B) as (X & Y & W). cbn zeta in *. rewrite X, Y, W.
  destruct (Z.eqb_spec s 255); [lia|]. reflexivity.
Qed.
Theorem decode_encode k : representable k -> decode (encode k) = Some k.
Proof.
  intros R. pose proof (representable_bound k R) as B. unfold encode. set (a := Z.abs k) in *.
  set (b := if k <? 0 then 1 else 0).
  replace (if k <? 0 then 2 ^ 31 else 0) with (b * 2 ^ 31) by (unfold b; destruct (k <? 0); reflexivity).
  assert (Hb : 0 <= b <= 1) by (unfold b; destruct (k <? 0); lia).
  assert (K : (if b =? 0 then a else - a) = k) by (unfold b, a; destruct (Z.ltb_spec k 0); cbn; lia).
  destruct (Z.ltb_spec a (2 ^ 23)) as [L|L].
  - replace (b * 2 ^ 31 + a) with (b * 2 ^ 31 + 0 * 2 ^ 23 + a) by ring. rewrite decode_parts by lia. cbn [Z.eqb]. now rewrite K.
  - destruct (Z.log2_spec a ltac:(lia)) as [P Q]. set (l := Z.log2 a) in *. set (s := l - 23).
    assert (23 <= l) by (apply Z.log2_le_pow2; lia).
    assert (P' : 2 ^ s * 2 ^ 23 <= a) by (rewrite <- Z.pow_add_r by lia; replace (s + 23) with l by lia; exact P).
    assert (Q' : a < 2 ^ s * 2 ^ 24) by (rewrite <- Z.pow_add_r by lia; replace (s + 24) with (Z.succ l) by lia; exact Q).
    pose proof (pow_pos s ltac:(lia)) as Ps.
    assert (S : s <= 253).
    { destruct (Z.le_gt_cases s 253) as [|X]; [assumption|exfalso].
      assert (2 ^ 254 <= 2 ^ s) by (apply Z.pow_le_mono_r; lia). unfold largest in B. lia. }
    assert (Dv : exists m, a = m * 2 ^ s).
    { destruct R as (m & t & M & T & E). assert (s <= t).
      { destruct (Z.le_gt_cases s t) as [|X]; [assumption|exfalso].
        assert (a = Z.abs m * 2 ^ t) by (unfold a; rewrite E, Z.abs_mul, (Z.abs_eq (2 ^ t)) by (pose proof (pow_pos t); lia); reflexivity).
        assert (2 ^ (t + 1) <= 2 ^ s) by (apply Z.pow_le_mono_r; lia). rewrite Z.pow_add_r in * by lia.
        pose proof (pow_pos t ltac:(lia)). nia. }
      exists (Z.abs m * 2 ^ (t - s)). unfold a. rewrite E, Z.abs_mul, (Z.abs_eq (2 ^ t)) by (pose proof (pow_pos t); lia).
      rewrite <- Z.mul_assoc, <- Z.pow_add_r by lia. do 2 f_equal. lia. }
    destruct Dv as [m Em]. rewrite Em, Z.div_mul by lia.
    assert (2 ^ 23 <= m < 2 ^ 24) by nia.
    replace (b * 2 ^ 31 + (s * 2 ^ 23 + m)) with (b * 2 ^ 31 + (s + 1) * 2 ^ 23 + (m - 2 ^ 23)) by ring.
    rewrite decode_parts by lia. destruct (Z.eqb_spec (s + 1) 0); [lia|]. cbn zeta.
    replace ((2 ^ 23 + (m - 2 ^ 23)) * 2 ^ (s + 1 - 1)) with a
      by (rewrite Em; replace (s + 1 - 1) with s by ring; ring). now rewrite K.
Qed.
Lemma some_injective (x y : Z) : Some x = Some y -> x = y.
Proof. congruence. Qed.
Theorem decode_representable b k : decode b = Some k -> representable k.
Proof.
  unfold decode. pose proof (Z.mod_pos_bound (b / 2 ^ 23) (2 ^ 8) ltac:(lia)). pose proof (Z.mod_pos_bound b (2 ^ 23) ltac:(lia)).
  set (e := (b / 2 ^ 23) mod 2 ^ 8) in *. set (m := b mod 2 ^ 23) in *. clearbody e m.
  destruct (Z.eqb_spec e 255); [discriminate|]. intros E. apply some_injective in E. subst k.
  assert (R : representable (if e =? 0 then m else (2 ^ 23 + m) * 2 ^ (e - 1))).
  { destruct (Z.eqb_spec e 0).
    - exists m, 0. split; [lia|]. split; [lia|]. ring.
    - exists (2 ^ 23 + m), (e - 1). split; [lia|]. split; [lia|]. reflexivity. }
  destruct (b <? 2 ^ 31); [exact R|now apply representable_opp].
Qed.
