# A value of an attribute (StoreMeans in shade-inl.hpp): V = u0 + T1 + T2, T = b (u - u0) for the weights b as computed; each difference,
# product and sum rounded, or some not. What is bounded is the error as a part of V, of T1 and of T2.
{ |s1| <= 1b-53 /\ |s2| <= 1b-53 /\ |m1| <= 1b-53 /\ |m2| <= 1b-53 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53
  -> |(1 + r1) * (1 + r2) - 1| in [0, 0x2.1p-53] /\
     |((1 + s1) * (1 + m1) - 1) * (1 + r1) * (1 + r2)| in [0, 0x2.1p-53] /\
     |(1 + s2) * (1 + m2) * (1 + r2) - (1 + r1) * (1 + r2)| in [0, 0x3.1p-53] }
(1 + s2) * (1 + m2) * (1 + r2) - (1 + r1) * (1 + r2) -> ((1 + s2) * (1 + m2) - 1 - r1) * (1 + r2);
