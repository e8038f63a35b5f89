# Depth of a large triangle in double (Large in draw_tile-inl.hpp): at a tile's first sample, z + (zx ax + zy ay); from there the least depth of the
# tile and of its first block, and the range of an area, by which hidden ones are left out and clipped ones are found. fx = min(0, zx), fy = min(0, zy),
# times 63, 7 or 15 samples; the error bound is taken off. With each term at most 1, these are below 5 units of 2^-53 for 3 terms, 14 for 6, 26 for 8 and
# more, where z_error has room for 16 a term (2 kEdgeErrorBound in set_up-inl.hpp). The worst case by hand, of each magnitude as many units as roundings that
# it passes: of abs(z) 4; of the way to the tile, which is the box's size and 63 (abs(zx) + abs(zy)), 6; of 63 (abs(zx) + abs(zy)) besides, 48/63 of 5 and 15/63 of 4.
# A sample's own depth (DepthByPlane in fragments-inl.hpp) is computed as a tile's.
@d = float<ieee_64,ne>;
tile = d(z + d(d(ax) + d(ay)));
fall = d(fx + fy);
least = d(tile + d(d(63 * fall) - error));
block = d(d(tile + d(7 * fall)) - error);
area = d(tile + d(d(rx) + d(ry)));
low = d(d(area + d(15 * fall)) - error);
{ |z| <= 1 /\ |error| <= 1 /\ |ax| <= 1 /\ |ay| <= 1 /\ |rx| <= 1 /\ |ry| <= 1 /\ |63 * fx| <= 1 /\ |63 * fy| <= 1
  -> |tile - (z + (ax + ay))| in [0, 5b-53]
  /\ |least - ((z + (ax + ay)) + (63 * (fx + fy) - error))| in [0, 14b-53]
  /\ |block - (((z + (ax + ay)) + 7 * (fx + fy)) - error)| in [0, 14b-53]
  /\ |low - ((((z + (ax + ay)) + (rx + ry)) + 15 * (fx + fy)) - error)| in [0, 26b-53] }
