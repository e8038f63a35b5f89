# The filter of an edge function (kEdgeErrorBound in edge.hpp): E = a x + b y + c in double, where a, b, c carry one rounding each. Scaled so
# that no term is above 1; the error is below 4.01 units of 2^-53 a term, and the filter allows 8.
@d = float<ieee_64,ne>;
a = d(ar); b = d(br); c = d(cr);
ax = d(a * x); by = d(b * y);
{ |ar * x| <= 1 /\ |br * y| <= 1 /\ |cr| <= 1 /\ |ar| <= 1 /\ |br| <= 1 /\ |x| <= 1 /\ |y| <= 1
  -> |d(d(ax + by) + c) - (ar * x + br * y + cr)| in [0, 24b-53] }
