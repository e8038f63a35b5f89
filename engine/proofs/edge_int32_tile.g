# The same for tiles of 64 x 64 samples (kTileBound in record.hpp): coefficients below 2^23, 63 steps each way, bound 64 units.
@i = int<ne>;
ai = i(as); bi = i(bs); ei = i(es);
{ |as| <= 8388608 /\ |bs| <= 8388608 /\ |es| <= 1073741824 /\ |es - E| <= 0.26 /\ dx in [0,63] /\ dy in [0,63]
  -> |(ei + ai * dx + bi * dy) - (E + as * dx + bs * dy)| in [0,63.77]
  /\ |ei + ai * dx + bi * dy| in [0,2147483647] }
(ei + ai * dx + bi * dy) - (E + as * dx + bs * dy) -> (ei - es) + (es - E) + (ai - as) * dx + (bi - bs) * dy;
