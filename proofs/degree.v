(* SPDX-License-Identifier: Apache-2.0 *)
(* T2: front-facing minus back-facing covers of a closed mesh is one number for all samples. *)
Require Import ZArith Lia List Bool Permutation.
From Surefill Require Import definitions coverage.
Import ListNotations.
Open Scope Z_scope.

Definition sum {A} (f : A -> Z) (l : list A) := fold_right (fun x s => f x + s) 0 l.
Definition edges (t : tri) := let '(u, v, w) := t in [(u, v); (v, w); (w, u)].
Definition swap (e : vec * vec) := (snd e, fst e).
(* Closed and consistently oriented: each directed edge occurs as often as its reverse. *)
Definition closed_mesh (mesh : list tri) := Permutation (flat_map edges mesh) (map swap (flat_map edges mesh)).
(* The hull of the three vertices contains the origin of (X, Y, W). *)
Definition contains_eye (t : tri) := let '(u, v, w) := t in
  exists k l m, 0 <= k /\ 0 <= l /\ 0 <= m /\ 0 < k + l + m /\ plus (scale k u) (plus (scale l v) (scale m w)) = zero.
(* 1 for a front-facing cover, -1 for a back-facing one (F1, clockwise). *)
Definition signed r t p : Z := if covers r t p then Z.sgn (D t) else 0.
Definition degree r mesh p := sum (fun t => signed r t p) mesh.

(* ---------------------------------------------------------------------------------- Signs of ten determinants *)

Notation sg x := (x ?= 0).
Definition all4 (a b c d : comparison) : Z :=
  match a, b, c, d with Gt, Gt, Gt, Gt => 1 | Lt, Lt, Lt, Lt => -1 | _, _, _, _ => 0 end.
Definition mul (a b : comparison) := match a with Gt => b | Eq => Eq | Lt => CompOpp b end.
Definition is_gt c := match c with Gt => true | _ => false end.
Definition is_lt c := match c with Lt => true | _ => false end.
Definition nonzero c := match c with Eq => false | _ => true end.
(* Signs of three numbers that add up to 0, and of three of which some are positive and some negative. *)
Definition zero3 a b c := eqb (is_gt a || is_gt b || is_gt c) (is_lt a || is_lt b || is_lt c).
Definition mixed a b c := (is_gt a || is_gt b || is_gt c) && (is_lt a || is_lt b || is_lt c).

(* e and f are the edge functions at p and q, a the determinants of each vertex with p and q. *)
Definition pattern (d e0 e1 e2 f0 f1 f2 a0 a1 a2 : comparison) : bool := implb
  (nonzero a0 && nonzero a1 && nonzero a2 &&
   (if nonzero d then nonzero e0 && nonzero e1 && nonzero e2 && nonzero f0 && nonzero f1 && nonzero f2
    else mixed e0 e1 e2) &&
   zero3 (mul d a0) (mul e2 f1) (CompOpp (mul f2 e1)) && zero3 (mul d a1) (mul e0 f2) (CompOpp (mul f0 e2)) &&
   zero3 (mul d a2) (mul e1 f0) (CompOpp (mul f1 e0)) &&
   zero3 (mul e0 a0) (mul e1 a1) (mul e2 a2) && zero3 (mul f0 a0) (mul f1 a1) (mul f2 a2))
  (all4 d e0 e1 e2 - all4 d f0 f1 f2 =?
   all4 a1 (CompOpp a0) (CompOpp f2) e2 + (all4 a2 (CompOpp a1) (CompOpp f0) e0 + all4 a0 (CompOpp a2) (CompOpp f1) e1)).
Definition signs := [Lt; Eq; Gt].
Lemma in_signs c : In c signs.
Proof. destruct c; cbn; auto. Qed.
Lemma patterns_all : forallb (fun d => forallb (fun e0 => forallb (fun e1 => forallb (fun e2 => forallb (fun f0 =>
  forallb (fun f1 => forallb (fun f2 => forallb (fun a0 => forallb (fun a1 => forallb (fun a2 =>
    pattern d e0 e1 e2 f0 f1 f2 a0 a1 a2) signs) signs) signs) signs) signs) signs) signs) signs) signs) signs = true.
Proof. vm_compute. reflexivity. Qed.
Lemma patterns d e0 e1 e2 f0 f1 f2 a0 a1 a2 : pattern d e0 e1 e2 f0 f1 f2 a0 a1 a2 = true.
Proof.
  pose proof patterns_all as H.
  rewrite forallb_forall in H. specialize (H d (in_signs d)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H e0 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H e1 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H e2 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H f0 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H f1 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H f2 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H a0 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. specialize (H a1 (in_signs _)). cbn beta in H.
  rewrite forallb_forall in H. exact (H a2 (in_signs _)).
Qed.

Lemma sg_cases x : (x < 0 /\ sg x = Lt) \/ (x = 0 /\ sg x = Eq) \/ (0 < x /\ sg x = Gt).
Proof. destruct (Z.compare_spec x 0); auto; right; right; split; auto; lia. Qed.
Lemma sg_mul x y : mul (sg x) (sg y) = sg (x * y).
Proof.
  destruct (sg_cases x) as [[? ->]|[[? ->]|[? ->]]], (sg_cases y) as [[? ->]|[[? ->]|[? ->]]],
    (sg_cases (x * y)) as [[? ->]|[[? ->]|[? ->]]]; cbn; try reflexivity; nia.
Qed.
Lemma sg_opp x : CompOpp (sg x) = sg (- x).
Proof. destruct x; reflexivity. Qed.
Lemma sg_nonzero x : x <> 0 -> nonzero (sg x) = true.
Proof. destruct x; cbn; auto; lia. Qed.
Lemma zero3_sound x y z : x + y + z = 0 -> zero3 (sg x) (sg y) (sg z) = true.
Proof.
  destruct (sg_cases x) as [[? ->]|[[? ->]|[? ->]]], (sg_cases y) as [[? ->]|[[? ->]|[? ->]]],
    (sg_cases z) as [[? ->]|[[? ->]|[? ->]]]; intros; cbn; try reflexivity; lia.
Qed.
Lemma mixed_sound x y z : ~ (0 <= x /\ 0 <= y /\ 0 <= z) -> ~ (x <= 0 /\ y <= 0 /\ z <= 0) ->
  mixed (sg x) (sg y) (sg z) = true.
Proof.
  destruct (sg_cases x) as [[? ->]|[[? ->]|[? ->]]], (sg_cases y) as [[? ->]|[[? ->]|[? ->]]],
    (sg_cases z) as [[? ->]|[[? ->]|[? ->]]]; intros; cbn; try reflexivity; lia.
Qed.
Lemma all4_opp a b c d : all4 (CompOpp a) (CompOpp b) (CompOpp c) (CompOpp d) = - all4 a b c d.
Proof. destruct a, b, c, d; reflexivity. Qed.
Lemma all4_swap a b c d : all4 a b c d = all4 b a c d.
Proof. destruct a, b, c, d; reflexivity. Qed.

(* ------------------------------------------------------------------------------------------- From p to q, locally *)

Definition scover (t : tri) (p : vec) : Z := all4 (sg (D t)) (sg (E0 t p)) (sg (E1 t p)) (sg (E2 t p)).
(* How edge u v and the arc from p to q cross. *)
Definition chi (p q : vec) (e : vec * vec) : Z :=
  let '(u, v) := e in all4 (sg (det v p q)) (CompOpp (sg (det u p q))) (CompOpp (sg (det u v q))) (sg (det u v p)).
Lemma chi_swap p q e : chi p q (swap e) = - chi p q e.
Proof.
  destruct e as [u v]. unfold swap, chi; cbn [fst snd]. rewrite <- all4_opp, all4_swap.
  rewrite !sg_opp, (det_swap u v q), (det_swap u v p). rewrite Z.opp_involutive.
  rewrite <- !sg_opp. destruct (sg (det u p q)), (sg (det v p q)), (sg (det u v q)), (sg (det u v p)); reflexivity.
Qed.

Definition sees (u v p : vec) := parallel u v \/ det u v p <> 0.
Definition generic (t : tri) (p q : vec) := let '(u, v, w) := t in
  (sees u v p /\ sees v w p /\ sees w u p) /\ (sees u v q /\ sees v w q /\ sees w u q) /\
  (sees u p q /\ sees v p q /\ sees w p q).

Lemma det_twice u p : det u p p = 0 /\ det p u p = 0.
Proof. unfold det, ea, eb, ec. split; ring. Qed.
Lemma zero_eye u v w k l m : plus (scale k u) (plus (scale l v) (scale m w)) = zero ->
  ~ contains_eye (u, v, w) -> k <> 0 \/ l <> 0 \/ m <> 0 ->
  ~ (0 <= k /\ 0 <= l /\ 0 <= m) /\ ~ (k <= 0 /\ l <= 0 /\ m <= 0).
Proof.
  intros H N Z0. split; intros C; apply N.
  - exists k, l, m. repeat split; try lia. exact H.
  - exists (- k), (- l), (- m). repeat split; try lia. revert H. unfold plus, scale, zero; cbn.
    injection 1 as X Y W. f_equal; lia.
Qed.

Lemma eye_cyclic u v w : contains_eye (v, w, u) -> contains_eye (u, v, w).
Proof.
  intros (k & l & m & K & L & M & P & H). exists m, k, l. repeat split; try lia.
  rewrite <- H. unfold plus; cbn. f_equal; ring.
Qed.
Lemma vector_identity u v w p :
  plus (scale (det v w p) u) (plus (scale (det w u p) v) (scale (det u v p) w)) = scale (det u v w) p.
Proof. unfold plus, scale, det, ea, eb, ec; cbn; f_equal; ring. Qed.

(* No vertex is on the ray of p. *)
Lemma apart u v w p : ~ contains_eye (u, v, w) -> sees u v p ->
  det v w p <> 0 \/ det w u p <> 0 \/ det u v p <> 0 -> ~ parallel u p.
Proof.
  intros N S Z0 P.
  assert (e1 : det w u p = 0) by (rewrite det_cyc; now apply det_parallel).
  assert (e2 : det u v p = 0) by (rewrite <- det_cyc, det_swap, <- Z.opp_0; f_equal; now apply det_parallel).
  assert (e0 : det v w p <> 0) by tauto.
  destruct S as [S|S]; [|contradiction].
  pose proof (vector_identity u v w p) as K. rewrite e1, e2, (det_parallel u v w S) in K.
  assert (U : forall x, det v w p * x + 0 = 0 -> x = 0)
    by (intros x H; rewrite Z.add_0_r in H; apply Z.mul_eq_0 in H; tauto).
  revert K. unfold plus, scale; cbn [vx vy vw]. injection 1 as X Y W.
  apply N. exists 1, 0, 0. repeat split; try lia. unfold plus, scale, zero; cbn [vx vy vw].
  rewrite (U _ X), (U _ Y), (U _ W). reflexivity.
Qed.

Lemma local t p q : ~ contains_eye t -> generic t p q -> scover t p - scover t q = sum (chi p q) (edges t).
Proof.
  destruct t as [[u v] w]. intros N ((P2 & P0 & P1) & (Q2 & Q0 & Q1) & A0 & A1 & A2).
  cbn [sum edges fold_right chi]. unfold scover. cbn [D E0 E1 E2]. rewrite Z.add_0_r.
  assert (Z0 : (det v w p = 0 /\ det w u p = 0 /\ det u v p = 0) \/ (det v w p <> 0 \/ det w u p <> 0 \/ det u v p <> 0)) by lia.
  destruct Z0 as [(z0 & z1 & z2)|NZ].
  { (* All three on one ray: nothing is covered, nothing is crossed. *)
    destruct P0 as [P0|]; [|contradiction]. destruct P1 as [P1|]; [|contradiction]. destruct P2 as [P2|]; [|contradiction].
    rewrite (det_parallel _ _ p P0), (det_parallel _ _ p P1), (det_parallel _ _ p P2),
      (det_parallel _ _ q P0), (det_parallel _ _ q P1), (det_parallel _ _ q P2).
    destruct (sg (det u v w)), (sg (det u p q)), (sg (det v p q)), (sg (det w p q)); reflexivity. }
  assert (N1 : ~ contains_eye (v, w, u)) by (intros H; apply N; now apply eye_cyclic).
  assert (N2 : ~ contains_eye (w, u, v)) by (intros H; apply N1; now apply eye_cyclic).
  destruct A0 as [A0|A0]; [destruct (apart u v w p N P2 ltac:(tauto) A0)|].
  destruct A1 as [A1|A1]; [destruct (apart v w u p N1 P0 ltac:(tauto) A1)|].
  destruct A2 as [A2|A2]; [destruct (apart w u v p N2 P1 ltac:(tauto) A2)|].
  pose proof (patterns (sg (det u v w)) (sg (det v w p)) (sg (det w u p)) (sg (det u v p))
    (sg (det v w q)) (sg (det w u q)) (sg (det u v q)) (sg (det u p q)) (sg (det v p q)) (sg (det w p q))) as H.
  unfold pattern in H. rewrite implb_true_iff in H. apply Z.eqb_eq, H.
  clear H. rewrite !andb_true_iff, !sg_mul, !sg_opp. repeat split; try now apply sg_nonzero.
  2-6: apply zero3_sound; unfold det, ea, eb, ec; ring.
  destruct (Z.eq_dec (det u v w) 0) as [z|n].
  - rewrite z. cbn [nonzero Z.compare].
    pose proof (vector_identity u v w p) as K. rewrite z in K.
    replace (scale 0 p) with zero in K by (unfold scale, zero; f_equal; ring).
    destruct (zero_eye u v w _ _ _ K N NZ). now apply mixed_sound.
  - rewrite (sg_nonzero _ n), !andb_true_iff.
    assert (S : forall x y z s, det x y z <> 0 -> sees x y s -> nonzero (sg (det x y s)) = true).
    { intros x y z s X [Y|Y]; [destruct X; now apply det_parallel|now apply sg_nonzero]. }
    assert (n1 : det v w u <> 0) by (now rewrite <- det_cyc). assert (n2 : det w u v <> 0) by (now rewrite <- det_cyc).
    repeat split; eapply S; eauto.
Qed.

(* ------------------------------------------------------------------------------------------- From C3 to points *)

Lemma sees_eventually r u v p : 0 < vw p -> eventually (fun a b => sees u v (perturbed r p a b)).
Proof.
  intros W. eapply eventually_weaken; [|apply (C3_sign r u v p W)]. cbn beta. intros a b H.
  destruct (Z.eq_dec (ea u v) 0) as [A|A], (Z.eq_dec (eb u v) 0) as [B|B], (Z.eq_dec (ec u v) 0) as [C|C];
    try (now left; repeat split).
  all: right; intros Z0; rewrite Z0 in H; cbn in H;
    destruct (edge_unit r u v p ltac:(lia)) as [E|E]; [unfold parallel; tauto|lia|lia].
Qed.
Lemma eventually_all {A} (Q : A -> Z -> Z -> Prop) l :
  (forall x, In x l -> eventually (Q x)) -> eventually (fun a b => forall x, In x l -> Q x a b).
Proof.
  induction l as [|x l IH]; intros H.
  - exists 1. split; [lia|]. intros a b _ _ x [].
  - eapply eventually_weaken; [|apply (eventually_and _ _ (H x (or_introl eq_refl)) (IH (fun y I => H y (or_intror I))))].
    cbn beta. intros a b [X Y] y [<-|I]; auto.
Qed.
Lemma scover_inside t q : scover t q = if inside t q then Z.sgn (D t) else 0.
Proof.
  destruct t as [[u v] w]. unfold scover, inside. cbn [D E0 E1 E2].
  destruct (sg_cases (det u v w)) as [[X ->]|[[X ->]|[X ->]]], (sg_cases (det v w q)) as [[A ->]|[[A ->]|[A ->]]],
    (sg_cases (det w u q)) as [[B ->]|[[B ->]|[B ->]]], (sg_cases (det u v q)) as [[C ->]|[[C ->]|[C ->]]];
    repeat match goal with
      | H : ?x < 0 |- _ => rewrite (Z.sgn_neg x H); clear H
      | H : 0 < ?x |- _ => rewrite (Z.sgn_pos x H); clear H
      | H : ?x = 0 |- _ => rewrite H; clear H
      end; reflexivity.
Qed.
Lemma signed_scover r t p : 0 < vw p -> eventually (fun a b => scover t (perturbed r p a b) = signed r t p).
Proof.
  intros W. eapply eventually_weaken; [|apply (C3_covers r t p W)]. intros a b [I _]. rewrite scover_inside, I. reflexivity.
Qed.

(* ------------------------------------------------------------------------------------------------- T2. Degree *)

Lemma sum_app {A} (f : A -> Z) l m : sum f (l ++ m) = sum f l + sum f m.
Proof. unfold sum. induction l; cbn; lia. Qed.
Lemma sum_perm {A} (f : A -> Z) l m : Permutation l m -> sum f l = sum f m.
Proof. unfold sum. induction 1; cbn; lia. Qed.
Lemma sum_ext {A} (f g : A -> Z) l : (forall x, In x l -> f x = g x) -> sum f l = sum g l.
Proof. induction l; cbn; intros H; [reflexivity|]. unfold sum in *. rewrite (H a), IHl; auto. Qed.

(* For points in general position, which perturbed samples are. *)
Lemma degree_generic mesh p q : closed_mesh mesh -> (forall t, In t mesh -> ~ contains_eye t) -> (forall t, In t mesh -> generic t p q) ->
  sum (fun t => scover t p) mesh = sum (fun t => scover t q) mesh.
Proof.
  intros C N G.
  assert (S : sum (fun t => scover t p) mesh - sum (fun t => scover t q) mesh = sum (chi p q) (flat_map edges mesh)).
  { clear C. induction mesh as [|t mesh IH]; [reflexivity|].
    cbn [flat_map]. rewrite sum_app, <- (local t p q) by (try apply N; try apply G; now left).
    rewrite <- IH by (intros; try apply N; try apply G; now right). cbn; unfold sum; lia. }
  assert (O : forall l, sum (chi p q) (map swap l) = - sum (chi p q) l).
  { induction l; [reflexivity|]. cbn [map sum fold_right]. unfold sum in *. rewrite chi_swap. lia. }
  pose proof (sum_perm (chi p q) _ _ C) as X. rewrite O in X. lia.
Qed.

(* T2. Any samples p and q, each with any fill rule, on vertices and edges too; degenerate triangles in the mesh. *)
Theorem T2_degree r s mesh p q : 0 < vw p -> 0 < vw q -> closed_mesh mesh -> (forall t, In t mesh -> ~ contains_eye t) ->
  degree r mesh p = degree s mesh q.
Proof.
  intros Wp Wq C N.
  (* First p', then q', which sees all vertices apart from p'. *)
  assert (P : eventually (fun a b => forall t, In t mesh -> scover t (perturbed r p a b) = signed r t p /\
    let '(u, v, w) := t in sees u v (perturbed r p a b) /\ sees v w (perturbed r p a b) /\ sees w u (perturbed r p a b))).
  { apply eventually_all. intros [[u v] w] _. apply eventually_and; [now apply signed_scover|].
    repeat apply eventually_and; now apply sees_eventually. }
  destruct (eventually_ex _ P) as (a & b & A & B & HP). set (p' := perturbed r p a b) in *.
  assert (Q : eventually (fun a b => forall t, In t mesh -> scover t (perturbed s q a b) = signed s t q /\
    let '(u, v, w) := t in
    (sees u v (perturbed s q a b) /\ sees v w (perturbed s q a b) /\ sees w u (perturbed s q a b)) /\
    (sees u p' (perturbed s q a b) /\ sees v p' (perturbed s q a b) /\ sees w p' (perturbed s q a b)))).
  { apply eventually_all. intros [[u v] w] _. apply eventually_and; [now apply signed_scover|].
    repeat apply eventually_and; now apply sees_eventually. }
  destruct (eventually_ex _ Q) as (a' & b' & A' & B' & HQ). set (q' := perturbed s q a' b') in *.
  unfold degree.
  rewrite <- (sum_ext (fun t => scover t p') (fun t => signed r t p)) by (intros; now apply HP).
  rewrite <- (sum_ext (fun t => scover t q') (fun t => signed s t q)) by (intros; now apply HQ).
  apply degree_generic; auto. intros [[u v] w] I. specialize (HP _ I). specialize (HQ _ I). cbn in HP, HQ. unfold generic. tauto.
Qed.
