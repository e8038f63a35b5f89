# Coverage of areas of 16 x 16 samples (kSmallBound in record.hpp): coefficients and start value are rounded to integers, all
# steps are integer additions. The total stays below the bound of 16 units.
#   as, bs  scaled coefficients, es the start value as computed in double, E the real start value
@i = int<ne>;
ai = i(as); bi = i(bs); ei = i(es);
{ |as| <= 33554432 /\ |bs| <= 33554432 /\ |es| <= 1073741824 /\ |es - E| <= 0.26 /\ dx in [0,15] /\ dy in [0,15]
  -> |(ei + ai * dx + bi * dy) - (E + as * dx + bs * dy)| in [0,15.77]
  /\ |ei + ai * dx + bi * dy| in [0,2147483647] }
(ei + ai * dx + bi * dy) - (E + as * dx + bs * dy) -> (ei - es) + (es - E) + (ai - as) * dx + (bi - bs) * dy;
