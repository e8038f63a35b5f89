# The same for a large triangle, from the tile's first sample on (SetUpDepth, PlaceDepth in draw_tile-inl.hpp): areas (ax, ay) of a tile, cells
# (cx, cy) of an area, samples (dx, dy) of a cell. With an error to be taken off of at most one quantum, it stays below 256 units of 2^-24
# (kTileParts).
@s = float<ieee_32,ne>;
zl = s(z); xl = s(zx); yl = s(zy);
area = s(zl + 16 * s(s(xl * ax) + s(yl * ay)));
cell = s(area + 4 * s(s(xl * cx) + s(yl * cy)));
least = s(s(s(xl * dx) + s(yl * dy)) - error);
sum = s(cell + least);
{ |z| <= 0.5 /\ |zx| <= 0.5 /\ |zy| <= 0.5 /\ ax in [0,3] /\ ay in [0,3] /\ cx in [0,3] /\ cy in [0,3] /\ dx in [0,3] /\ dy in [0,3] /\ error in [0,1]
  -> |sum - (z + 16 * (zx * ax + zy * ay) + 4 * (zx * cx + zy * cy) + (zx * dx + zy * dy) - error)| in [0, 256b-24] }
sum - (z + 16 * (zx * ax + zy * ay) + 4 * (zx * cx + zy * cy) + (zx * dx + zy * dy) - error) ->
  (sum - (cell + least)) + (cell - (area + 4 * s(s(xl * cx) + s(yl * cy)))) + (area - (zl + 16 * s(s(xl * ax) + s(yl * ay)))) + (zl - z)
  + 16 * ((s(s(xl * ax) + s(yl * ay)) - (s(xl * ax) + s(yl * ay))) + (s(xl * ax) - xl * ax) + (s(yl * ay) - yl * ay) + (xl - zx) * ax + (yl - zy) * ay)
  + 4 * ((s(s(xl * cx) + s(yl * cy)) - (s(xl * cx) + s(yl * cy))) + (s(xl * cx) - xl * cx) + (s(yl * cy) - yl * cy) + (xl - zx) * cx + (yl - zy) * cy)
  + (least - (s(s(xl * dx) + s(yl * dy)) - error))
  + (s(s(xl * dx) + s(yl * dy)) - (s(xl * dx) + s(yl * dy))) + (s(xl * dx) - xl * dx) + (s(yl * dy) - yl * dy) + (xl - zx) * dx + (yl - zy) * dy;
