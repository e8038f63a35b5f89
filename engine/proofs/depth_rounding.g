# Depth of the fast path (block-inl.hpp): z + (zx cx + zy cy) + (zx dx + zy dy) in double, all terms at most 1 together with their steps: the
# evaluation itself stays below 8 units of 2^-53 of |z| + |zx| rx + |zy| ry, here 3.
@d = float<ieee_64,ne>;
cell = d(z + d(d(zx * cx) + d(zy * cy)));
lane = d(d(zx * dx) + d(zy * dy));
{ |z| <= 1 /\ |zx * cx| <= 1 /\ |zy * cy| <= 1 /\ |zx * dx| <= 1 /\ |zy * dy| <= 1
  -> |d(cell + lane) - (z + (zx * cx + zy * cy) + (zx * dx + zy * dy))| in [0, 24b-53] }
