(* SPDX-License-Identifier: Apache-2.0 *)
(* V1, V2: the image does not depend on the order of work, nor, with identifiers, on the order of the triangles. M2. *)
Require Import ZArith Lia List Bool Permutation.
From Surefill Require Import definitions.
Import ListNotations.
Open Scope Z_scope.

(* What tells the fragments of a draw at a sample apart. *)
Definition key (f : fragment) := (index (source f), position (source f)).

(* An order in which fragments of different keys are never alike. *)
Record strict_order (lt : fragment -> fragment -> bool) := {
  irreflexive : forall f, lt f f = false;
  transitive : forall f g h, lt f g = true -> lt g h = true -> lt f h = true;
  weak : forall f g h, lt f g = false -> lt g h = false -> lt f h = false;
  total : forall f g, key f <> key g -> lt f g = true \/ lt g f = true
}.

Ltac orders := unfold nearer, later, before in *;
  rewrite ?orb_true_iff, ?orb_false_iff, ?andb_true_iff, ?andb_false_iff, ?Z.ltb_lt, ?Z.ltb_ge, ?Z.eqb_eq, ?Z.eqb_neq in *.
Lemma key_differs f g : key f <> key g -> index (source f) <> index (source g) \/ position (source f) <> position (source g).
Proof.
  intros H. destruct (Z.eq_dec (index (source f)) (index (source g))) as [A|]; [|auto].
  right. intros B. apply H. unfold key. congruence.
Qed.
Theorem V1_strict_order greater : strict_order (nearer greater).
Proof.
  destruct greater; split; intros; try match goal with H : key _ <> key _ |- _ => apply key_differs in H end; orders; lia.
Qed.
Theorem M5_strict_order : strict_order later.
Proof.
  split; intros; try match goal with H : key _ <> key _ |- _ => apply key_differs in H end; orders; lia.
Qed.
(* V2, M5: of equal identifiers the one of smaller position is visible, without depth write the last one. *)
Theorem V2_position greater f g : depth f = depth g -> index (source f) = index (source g) ->
  position (source f) < position (source g) -> nearer greater f g = true /\ later g f = true.
Proof. intros A B C. split; orders; lia. Qed.
Lemma draw_order (d : draw) greater : strict_order (if depth_write d then nearer greater else later).
Proof. destruct (depth_write d); [apply V1_strict_order|exact M5_strict_order]. Qed.

(* Two results put together, as those of two threads are. *)
Definition merge (better : fragment -> fragment -> bool) (a b : option fragment) : option fragment :=
  match b with Some f => pick better a f | None => a end.

Lemma fold_merge better l a : strict_order better -> fold_left (pick better) l a = merge better a (best_of better l).
Proof.
  intros O. revert a. unfold best_of. induction l as [|f l IH]; intros a; [reflexivity|].
  cbn [fold_left]. rewrite IH, (IH (pick better None f)). cbn [pick].
  destruct (fold_left (pick better) l None) as [h|]; [|destruct a; reflexivity]. cbn [merge].
  destruct a as [g|]; cbn [pick]; [|destruct (better h f); reflexivity].
  destruct (better f g) eqn:FG, (better h f) eqn:HF; cbn [pick]; rewrite ?FG, ?HF; cbn [merge pick]; rewrite ?FG; try reflexivity.
  - now rewrite (transitive _ O h f g HF FG).
  - now rewrite (weak _ O h f g HF FG).
Qed.
(* V1: however the fragments are shared out among threads or tiles, with each part keeping its best. *)
Theorem V1_merge better l l' : strict_order better ->
  best_of better (l ++ l') = merge better (best_of better l) (best_of better l').
Proof. intros O. unfold best_of at 1. rewrite fold_left_app. now apply fold_merge. Qed.

Lemma pick_swap better a f g : strict_order better -> key f <> key g ->
  pick better (pick better a f) g = pick better (pick better a g) f.
Proof.
  intros O K.
  assert (FG : better f g = negb (better g f)).
  { destruct (better g f) eqn:A, (better f g) eqn:B; try reflexivity; exfalso.
    - pose proof (transitive _ O f g f B A). rewrite (irreflexive _ O) in *. discriminate.
    - destruct (total _ O f g K); congruence. }
  destruct a as [h|]; cbn [pick]; [|rewrite FG; destruct (better g f); reflexivity].
  destruct (better f h) eqn:FH, (better g h) eqn:GH; cbn [pick]; rewrite ?FH, ?GH, ?FG.
  - destruct (better g f); reflexivity.
  - destruct (better g f) eqn:GF; [|reflexivity]. pose proof (transitive _ O g f h GF FH). congruence.
  - destruct (better g f) eqn:GF; [reflexivity|]. cbn [negb] in FG. pose proof (transitive _ O f g h FG GH). congruence.
  - reflexivity.
Qed.
(* V1: the best fragment does not depend on the order in which they come. *)
Theorem V1_order better l l' : strict_order better -> Permutation l l' -> NoDup (map key l) ->
  best_of better l = best_of better l'.
Proof.
  intros O P. unfold best_of. generalize (@None fragment).
  induction P as [|f l l' P IH|f g l|l l' l'' P IH P' IH']; intros a N; cbn [fold_left map] in *.
  - reflexivity.
  - apply IH. now inversion N.
  - rewrite (pick_swap better a g f O); [reflexivity|]. inversion N as [|? ? I _]. intros E. apply I. left. now symmetry.
  - rewrite IH by assumption. apply IH'. eapply Permutation_NoDup; [apply Permutation_map; exact P|exact N].
Qed.
Lemma best_some better l f : fold_left (pick better) l (Some f) <> None.
Proof.
  revert f. induction l as [|g l IH]; intros f; cbn [fold_left pick]; [discriminate|]. destruct (better g f); apply IH.
Qed.
(* And it is the best: it is one of them, and none is better. *)
Theorem V1_best better l f : strict_order better -> best_of better l = Some f -> In f l /\ forall g, In g l -> better g f = false.
Proof.
  intros O. revert f. induction l as [|h l IH]; intros f; [discriminate|].
  change (h :: l) with ([h] ++ l) at 1. rewrite V1_merge by assumption. change (best_of better [h]) with (Some h).
  destruct (best_of better l) as [g|] eqn:B; cbn [merge pick].
  - destruct (IH g eq_refl) as [I W]. destruct (better g h) eqn:GH; injection 1 as <-; (split; [cbn; auto|]).
    + intros x [<-|X]; [|now apply W]. destruct (better h g) eqn:HG; [|reflexivity].
      pose proof (transitive _ O h g h HG GH) as C. rewrite (irreflexive _ O) in C. discriminate.
    + intros x [<-|X]; [apply (irreflexive _ O)|]. apply (weak _ O x g h); auto.
  - injection 1 as <-. split; [now left|]. intros x [<-|X]; [apply (irreflexive _ O)|].
    destruct l as [|y l]; [destruct X|]. destruct (best_some better l y B).
Qed.
(* Where there is a fragment there is a best one. *)
Theorem V1_exists better l : l <> [] -> best_of better l <> None.
Proof. destruct l; [congruence|]. intros _. apply best_some. Qed.

(* ------------------------------------------------------------------------------------------ V2: the triangles' order *)

(* A triangle, a fragment and a sample without the position in the draw. *)
Definition placeless (t : triangle) := Triangle (c0 t) (c1 t) (c2 t) (index t) 0.
Definition placeless_fragment (f : fragment) := Fragment (depth f) (placeless (source f)).
Definition placeless_sample (s : sample) :=
  Sample (count s) (match visible s with Some (r, t) => Some (r, placeless t) | None => None end) (bits s).

Lemma fragments_placeless d i j p l :
  map placeless_fragment (fragments_of d i j p l) = fragments_of d i j p (map placeless l).
Proof.
  induction l as [|t l IH]; [reflexivity|]. cbn [fragments_of map].
  assert (E : fragment_of d i j p (placeless t) = option_map placeless_fragment (fragment_of d i j p t)).
  { unfold fragment_of. change (shape (placeless t)) with (shape t). cbn [placeless c0 c1 c2].
    destruct (in_scissor _ _ _ && _ && _); [|reflexivity]. destruct (depth_of _ _); reflexivity. }
  rewrite E. destruct (fragment_of d i j p t); cbn [option_map map]; now rewrite IH.
Qed.
Lemma fragments_permutation d i j p l l' : Permutation l l' -> Permutation (fragments_of d i j p l) (fragments_of d i j p l').
Proof.
  induction 1 as [|x l l' _ IH|x y l|l l' l'' _ IH _ IH']; cbn [fragments_of].
  - constructor.
  - destruct (fragment_of d i j p x); auto.
  - destruct (fragment_of d i j p x), (fragment_of d i j p y); auto using perm_swap, Permutation_refl.
  - exact (Permutation_trans IH IH').
Qed.
Lemma fragments_source d i j p l f : In f (fragments_of d i j p l) -> In (source f) l.
Proof.
  induction l as [|t l IH]; [intros []|]. cbn [fragments_of]. unfold fragment_of at 1.
  destruct (_ && _); [destruct (depth_of _ _)|]; cbn; intros H; [destruct H as [<-|H]; [now left|]|..]; right; auto.
Qed.
Lemma fragments_nodup d i j p l : NoDup (map index l) -> NoDup (map (fun f => index (source f)) (fragments_of d i j p l)).
Proof.
  induction l as [|t l IH]; intros N; [constructor|]. inversion N as [|? ? I N']. subst. cbn [fragments_of].
  destruct (fragment_of d i j p t) as [f|] eqn:F; [|auto]. cbn [map]. constructor; [|auto].
  assert (source f = t) as ->.
  { unfold fragment_of in F. destruct (_ && _); [|discriminate]. destruct (depth_of _ _); [|discriminate]. now injection F as <-. }
  intros H. apply I. apply in_map_iff in H as (g & E & G). apply fragments_source in G. rewrite <- E. now apply in_map.
Qed.

(* Where no two indices are equal, positions decide nothing. *)
Definition by_index (better : fragment -> fragment -> bool) := forall f g,
  index (source f) <> index (source g) -> better (placeless_fragment f) (placeless_fragment g) = better f g.
Lemma draw_by_index (d : draw) greater : by_index (if depth_write d then nearer greater else later).
Proof.
  intros f g N. destruct (depth_write d), greater; unfold nearer, later, before; cbn;
    destruct (Z.eqb_spec (index (source f)) (index (source g))), (Z.eqb_spec (index (source g)) (index (source f)));
    try congruence; reflexivity.
Qed.
Lemma best_placeless better l a : by_index better ->
  NoDup (map (fun f => index (source f)) (match a with Some f => f :: l | None => l end)) ->
  option_map placeless_fragment (fold_left (pick better) l a) =
  fold_left (pick better) (map placeless_fragment l) (option_map placeless_fragment a).
Proof.
  intros B. revert a. induction l as [|f l IH]; intros a N; [reflexivity|]. cbn [fold_left map].
  destruct a as [g|]; cbn [option_map pick map] in *.
  - inversion N as [|? ? I N']. inversion N' as [|? ? I' N'']. subst. rewrite B by (intros E; apply I; left; exact E).
    destruct (better f g); (rewrite IH; [reflexivity|]); cbn [map]; constructor; auto. intros H. apply I. now right.
  - rewrite IH by assumption. reflexivity.
Qed.
Lemma passing_placeless q l :
  map placeless_fragment (filter (fun f => q (depth f)) l) = filter (fun f => q (depth f)) (map placeless_fragment l).
Proof. induction l as [|f l IH]; [reflexivity|]. cbn. destruct (q (depth f)); cbn; now rewrite IH. Qed.
Lemma filter_nodup {A} (q : fragment -> bool) (k : fragment -> A) l : NoDup (map k l) -> NoDup (map k (filter q l)).
Proof.
  induction l as [|f l IH]; intros N; [constructor|]. inversion N as [|? ? I N']. subst. cbn [filter].
  destruct (q f); [|auto]. cbn [map]. constructor; [|auto]. intros H. apply I.
  apply in_map_iff in H as (g & E & G). apply filter_In in G as [G _]. rewrite <- E. now apply in_map.
Qed.
Lemma filter_permutation {A} (q : A -> bool) l l' : Permutation l l' -> Permutation (filter q l) (filter q l').
Proof.
  induction 1; cbn; auto; [destruct (q x); auto|destruct (q x), (q y); auto using perm_swap, Permutation_refl|eapply Permutation_trans; eassumption].
Qed.

Definition with_triangles (d : draw) l := Draw (rule d) (counter_clockwise d) (cull d) (mode d) (depth_write d) (scissor d) l.

Lemma fragments_with d m i j p l : fragments_of (with_triangles d m) i j p l = fragments_of d i j p l.
Proof.
  induction l as [|t l IH]; [reflexivity|]. cbn [fragments_of]. rewrite IH. reflexivity.
Qed.

(* A sample of a draw, up to positions, is that of the draw's triangles without positions. *)
Lemma draw_placeless greater i j p old d : NoDup (map index (triangles d)) ->
  placeless_sample (draw_sample greater i j p old d) =
  placeless_sample (draw_sample greater i j p old (with_triangles d (map placeless (triangles d)))).
Proof.
  intros N. unfold draw_sample, resolve. cbn [with_triangles triangles depth_write rule].
  rewrite fragments_with, <- fragments_placeless, map_length.
  set (l := fragments_of d i j p (triangles d)).
  assert (Nl : NoDup (map (fun f => index (source f)) l)) by now apply fragments_nodup. clearbody l.
  rewrite <- (passing_placeless (fun k => beats greater k (stored_of_bits (bits old)))).
  set (passing := filter _ l). assert (Np : NoDup (map (fun f => index (source f)) passing)) by now apply filter_nodup.
  clearbody passing. unfold best_of. set (better := if depth_write d then nearer greater else later).
  pose proof (best_placeless better passing None (draw_by_index d greater) Np) as B. cbn [option_map] in B. rewrite <- B.
  destruct (fold_left (pick better) passing None) as [f|]; [|reflexivity]. reflexivity.
Qed.

(* V2: with unique identifiers, any permutation of the triangles (whose positions change) gives the same sample: the same
   count, depth and visible triangle, so the same values too. *)
Theorem V2_permutation greater i j p old d l : Permutation (map placeless (triangles d)) (map placeless l) ->
  NoDup (map index (triangles d)) ->
  placeless_sample (draw_sample greater i j p old d) = placeless_sample (draw_sample greater i j p old (with_triangles d l)).
Proof.
  intros P N.
  assert (I : forall l, map index (map placeless l) = map index l) by (intros; rewrite map_map; reflexivity).
  assert (N' : NoDup (map index l)).
  { rewrite <- I. eapply Permutation_NoDup; [apply Permutation_map; exact P|]. now rewrite I. }
  rewrite (draw_placeless _ _ _ _ _ d N), (draw_placeless _ _ _ _ _ (with_triangles d l) N').
  cbn [with_triangles triangles]. f_equal. unfold draw_sample, resolve. cbn [with_triangles triangles depth_write rule].
  rewrite !fragments_with.
  set (f := fragments_of d i j p (map placeless (triangles d))). set (f' := fragments_of d i j p (map placeless l)).
  assert (Q : Permutation f f') by now apply fragments_permutation.
  rewrite (Permutation_length Q).
  rewrite (V1_order _ _ _ (draw_order d greater) (filter_permutation _ _ _ Q)); [reflexivity|].
  apply filter_nodup. unfold f.
  assert (K : NoDup (map (fun g => index (source g)) (fragments_of d i j p (map placeless (triangles d)))))
    by (apply fragments_nodup; now rewrite I).
  revert K. generalize (fragments_of d i j p (map placeless (triangles d))). intros m K.
  apply (NoDup_map_inv fst). rewrite map_map. exact K.
Qed.
Theorem V2_values how centroid samples i j s : values_of how centroid samples i j (placeless_sample s) = values_of how centroid samples i j s.
Proof. unfold values_of, placeless_sample; cbn [visible]. destruct (visible s) as [[r t]|]; reflexivity. Qed.

(* ----------------------------------------------------------------------------------------------- M2: counts *)

(* The count is the number of fragments of all draws: depth test, depth write and initial depth have no part in it. *)
Theorem M2_count greater initial draws i j p : count (render_sample greater initial draws i j p) =
  fold_right (fun d n => Z.of_nat (length (fragments_of d i j p (triangles d))) + n) 0 draws.
Proof.
  unfold render_sample. assert (H : forall s, count (fold_left (draw_sample greater i j p) draws s) =
    count s + fold_right (fun d n => Z.of_nat (length (fragments_of d i j p (triangles d))) + n) 0 draws).
  { induction draws as [|d draws IH]; intros s; cbn [fold_left fold_right]; [lia|]. rewrite IH.
    unfold draw_sample, resolve. destruct (best_of _ _); cbn [count]; lia. }
  rewrite H. reflexivity.
Qed.
