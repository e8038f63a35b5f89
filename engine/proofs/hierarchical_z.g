# The least depth of a tile, and of a block in an area (block-inl.hpp): from the depth at a first sample, the fall within
# `reach` samples and the error, in double; fx = min(0, reach zx), gx = 8 zx for the second block of an area. With each
# term at most 1, six or eight of them: below 16 units of 2^-53 of their sum, here 2.5 and 2.2. The worst case by hand: of
# each magnitude as many units as roundings that it passes. So of abs(z) 3; of the fall, at most 63 (abs(zx) + abs(zy)), 6; of the
# steps to the first sample 3, and these may be as much larger than the box: 3 of its size and 9 of 63 (abs(zx) + abs(zy)).
@d = float<ieee_64,ne>;
fall = d(d(d(fx) + d(fy)) - error);
tile = d(d(ax) + d(d(ay) + d(z + fall)));
area = d(z + d(d(ax) + d(ay)));
block = d(area + d(fall + d(gx + gy)));
{ |z| <= 1 /\ |error| <= 1 /\ |ax| <= 1 /\ |ay| <= 1 /\ |fx| <= 1 /\ |fy| <= 1 /\ |gx| <= 1 /\ |gy| <= 1
  -> |tile - (ax + (ay + (z + ((fx + fy) - error))))| in [0, 15b-53]
  /\ |block - ((z + (ax + ay)) + (((fx + fy) - error) + (gx + gy)))| in [0, 17b-53] }
