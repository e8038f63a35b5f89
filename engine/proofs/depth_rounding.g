# Depth of the fast path (block-inl.hpp): z + (zx ax + zy ay) to an area, + 4 (zx cx + zy cy) to a cell, - error, + (zx dx + zy dy) to a sample,
# in double. With each term at most 1, eight of them: the evaluation stays below 16 units of 2^-53 of their sum, here 6.
@d = float<ieee_64,ne>;
area = d(z + d(d(zx * ax) + d(zy * ay)));
cell = d(area + 4 * d(d(zx * cx) + d(zy * cy)));
sample = d(d(cell - error) + d(d(zx * dx) + d(zy * dy)));
{ |z| <= 1 /\ |error| <= 1 /\ |zx * ax| <= 1 /\ |zy * ay| <= 1 /\ |zx * cx| <= 0.25 /\ |zy * cy| <= 0.25
  /\ |zx * dx| <= 1 /\ |zy * dy| <= 1
  -> |sample - (z + (zx * ax + zy * ay) + 4 * (zx * cx + zy * cy) - error + (zx * dx + zy * dy))| in [0, 48b-53] }
