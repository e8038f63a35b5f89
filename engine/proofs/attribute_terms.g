# A term T of a sum of products, after 1 to 8 roundings (Weigh in shade-inl.hpp): the error of a term of at most 1, in units of 2^-53. Any
# of the d may be 0, as where a product and a sum are rounded once.
T1 = T + T * d1; T2 = T1 + T1 * d2; T3 = T2 + T2 * d3; T4 = T3 + T3 * d4;
T5 = T4 + T4 * d5; T6 = T5 + T5 * d6; T7 = T6 + T6 * d7; T8 = T7 + T7 * d8;
{ |T| <= 1 /\ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53 /\
  |d5| <= 1b-53 /\ |d6| <= 1b-53 /\ |d7| <= 1b-53 /\ |d8| <= 1b-53
  -> |T4 - T| in [0, 0x4.1p-53] /\ |T7 - T| in [0, 0x7.2p-53] /\ |T8 - T| in [0, 0x8.2p-53] }
T2 - T -> (T1 - T) + T1 * d2; T3 - T -> (T2 - T) + T2 * d3; T4 - T -> (T3 - T) + T3 * d4; T5 - T -> (T4 - T) + T4 * d5;
T6 - T -> (T5 - T) + T5 * d6; T7 - T -> (T6 - T) + T6 * d7; T8 - T -> (T7 - T) + T7 * d8;
T1 - T -> T * d1;
