# The minor coordinate of a line in a column (Columns in lines.cpp): slope t + start, slope = -a / b and start = -c / b, where a, b and c carry
# one rounding each, and the quotients q and p, the product m and the sum s another. What is bounded is the error as a part of slope t and of
# start as computed.
{ |a| <= 1b-53 /\ |b| <= 1b-53 /\ |c| <= 1b-53 /\ |q| <= 1b-53 /\ |p| <= 1b-53 /\ |m| <= 1b-53 /\ |s| <= 1b-53
  -> |(1 + m) * (1 + s) - (1 + b) / ((1 + a) * (1 + q))| in [0, 0x5.1p-53] /\
     |(1 + s) - (1 + b) / ((1 + c) * (1 + p))| in [0, 0x4.1p-53] }
