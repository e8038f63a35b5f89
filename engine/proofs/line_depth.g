# Depth along a line (DepthOfLine in lines.cpp, Line::depth_along): slope t + start, both quotients of differences of exact products. The
# differences n, o and d, the quotients q and p, the product m and the sum s are rounded. What is bounded is the error as a part of the product
# and of start as computed.
{ |n| <= 1b-53 /\ |o| <= 1b-53 /\ |d| <= 1b-53 /\ |q| <= 1b-53 /\ |p| <= 1b-53 /\ |m| <= 1b-53 /\ |s| <= 1b-53
  -> |(1 + s) - (1 + d) / ((1 + n) * (1 + q) * (1 + m))| in [0, 0x5.1p-53] /\
     |(1 + s) - (1 + d) / ((1 + o) * (1 + p))| in [0, 0x4.1p-53] }
