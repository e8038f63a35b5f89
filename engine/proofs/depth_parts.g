# Depth in two float32 parts of a small triangle (Splitter in edges-inl.hpp, AddSmall in draw_tile-inl.hpp), in units of the quantum: sums of high parts are exact, so all error
# comes from low parts, over cells (cx, cy) of an area and samples (dx, dy) of a cell. With an error to be taken off of at most one
# quantum, it stays below 56 units of 2^-24 (kSmallParts); of a larger error two roundings more, for which there is a factor of 1 + 2^-20.
#   z, zx, zy  what is left of depth and of its steps when the high parts are taken away
@s = float<ieee_32,ne>;
zl = s(z); xl = s(zx); yl = s(zy);
cell = s(zl + 4 * s(s(xl * cx) + s(yl * cy)));
least = s(s(s(xl * dx) + s(yl * dy)) - error);
sum = s(cell + least);
{ |z| <= 0.5 /\ |zx| <= 0.5 /\ |zy| <= 0.5 /\ cx in [0,3] /\ cy in [0,3] /\ dx in [0,3] /\ dy in [0,3] /\ error in [0,1]
  -> |sum - (z + 4 * (zx * cx + zy * cy) + (zx * dx + zy * dy) - error)| in [0, 56b-24] }
sum - (z + 4 * (zx * cx + zy * cy) + (zx * dx + zy * dy) - error) ->
  (sum - (cell + least)) + (cell - (zl + 4 * s(s(xl * cx) + s(yl * cy)))) + (zl - z)
  + 4 * ((s(s(xl * cx) + s(yl * cy)) - (s(xl * cx) + s(yl * cy))) + (s(xl * cx) - xl * cx) + (s(yl * cy) - yl * cy) + (xl - zx) * cx + (yl - zy) * cy)
  + (least - (s(s(xl * dx) + s(yl * dy)) - error))
  + (s(s(xl * dx) + s(yl * dy)) - (s(xl * dx) + s(yl * dy))) + (s(xl * dx) - xl * dx) + (s(yl * dy) - yl * dy) + (xl - zx) * dx + (yl - zy) * dy;
