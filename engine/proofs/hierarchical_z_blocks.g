# The least depth of a large triangle in each block of a tile, in float32 (VisibleBlocks in hierarchical_z-inl.hpp), from that of the first block, which is known
# in double: x and y lead from one block to the next, 8 (zx, zy). With |z| + 64 (|zx| + |zy|) <= 1 and an error to be taken off of at most 1, float32 adds less
# than 8 units of 2^-24, where 16 are taken (kFloatBlocks); of a larger error three roundings, for which 16 units of it are taken, too. Rows of areas have two rows of blocks.
@s = float<ieee_32,ne>;
start = s(least); xs = s(x); ys = s(y);
steps = s(s(xs * column) + s(ys * row));
area = s(start + s(two_rows * ys));
nearest = s(area + steps);
{ |least| <= 2 /\ |x| <= 0.125 /\ |y| <= 0.125 /\ column in [0,7] /\ row in [0,1] /\ two_rows in [0,6]
  -> |nearest - (least + x * column + y * (two_rows + row))| in [0, 8b-24] }
nearest - (least + x * column + y * (two_rows + row)) ->
  (nearest - (area + steps)) + (area - (start + s(two_rows * ys))) + (start - least) + (s(two_rows * ys) - two_rows * ys) + (ys - y) * two_rows
  + (steps - (s(xs * column) + s(ys * row))) + (s(xs * column) - xs * column) + (s(ys * row) - ys * row) + (xs - x) * column + (ys - y) * row;
