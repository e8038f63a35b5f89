# Numerators and denominators of attributes on the fast path (Values in shade-inl.hpp): n = u0 e0 + u1 e1 + u2 e2 in double, where
# the edge values e_i stand for real E_i. Scaled so that no |u_i| and no error of an e_i is above 1; such an error is at least
# 2^-50 |e_i|. The sum's error is below 4.3 units, and the filter allows twice each: 6.
@d = float<ieee_64,ne>;
p0 = d(u0 * e0); p1 = d(u1 * e1); p2 = d(u2 * e2);
{ |u0| <= 1 /\ |u1| <= 1 /\ |u2| <= 1 /\ |e0| <= 1b50 /\ |e1| <= 1b50 /\ |e2| <= 1b50 /\
  |e0 - E0| <= 1 /\ |e1 - E1| <= 1 /\ |e2 - E2| <= 1
  -> |d(d(p0 + p1) + p2) - (u0 * E0 + u1 * E1 + u2 * E2)| in [0, 4.3] }
d(d(p0 + p1) + p2) - (u0 * E0 + u1 * E1 + u2 * E2) ->
  (d(d(p0 + p1) + p2) - (p0 + p1 + p2)) + (p0 - u0 * e0) + (p1 - u1 * e1) + (p2 - u2 * e2)
  + u0 * (e0 - E0) + u1 * (e1 - E1) + u2 * (e2 - E2);
