# Values of a line by scalar code (Line::Mix in line.hpp), of exact doubles: the error of a weighted sum as a part of each of its two terms as
# computed, a difference times a value; that of a sum of two differences of one sign, or of two amounts, as a part of itself; and of one difference.
{ |n| <= 1b-53 /\ |m| <= 1b-53 /\ |s| <= 1b-53
  -> |(1 + s) - 1 / ((1 + n) * (1 + m))| in [0, 0x3.1p-53] /\
     |1 - 1 / ((1 + n) * (1 + s))| in [0, 0x2.1p-53] /\
     |1 - 1 / (1 + n)| in [0, 0x1.1p-53] }
