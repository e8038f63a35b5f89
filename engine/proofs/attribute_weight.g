# The weight of a vertex (Weigh in shade-inl.hpp): b = n / (s + sigma) with two roundings, n = e + eps, for a real weight B = e / s of at
# most 1, where no real e is above 1, nor above s. What is bounded is the error times the computed sum: (b - B) (s + sigma).
n = e + eps; n1 = n + n * d1; n2 = n1 + n1 * d2;
{ |B| <= 1 /\ |e| <= 1 /\ |eps| <= 0x7.2p-53 /\ |sigma| <= 0x8.2p-53 /\ |d1| <= 1b-53 /\ |d2| <= 1b-53
  -> |n2 - (e + B * sigma)| in [0, 0x11.8p-53] }
n2 - (e + B * sigma) -> eps - B * sigma + n * d1 + n1 * d2;
