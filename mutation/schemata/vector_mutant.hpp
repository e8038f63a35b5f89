// SPDX-License-Identifier: Apache-2.0
//
// Mutants of vector operations: a call  hn::Add(a, b)  becomes  surefill::mutant::Add<7>(a, b), which subtracts while
// mutant 7 is alive. For one instruction set, chosen when this is compiled.
#ifndef SUREFILL_PROPERTIES_SCHEMATA_VECTOR_MUTANT_HPP
#define SUREFILL_PROPERTIES_SCHEMATA_VECTOR_MUTANT_HPP

#include "hwy/highway.h"
#include "mutant.hpp"

namespace surefill::mutant {

namespace hn = hwy::HWY_NAMESPACE;

// Highway has them for floating-point numbers only; integers have no NaN.
template <class Value>
HWY_INLINE auto less_or_equal(Value a, Value b) {
  if constexpr (hwy::IsFloat<hn::TFromV<Value>>()) {
    return hn::Le(a, b);
  } else {
    return hn::Not(hn::Lt(b, a));
  }
}
template <class Value>
HWY_INLINE auto greater_or_equal(Value a, Value b) {
  return less_or_equal(b, a);
}

#define SUREFILL_VECTOR_MUTANT(name, instead)             \
  template <unsigned N, class... Arguments>               \
  HWY_INLINE auto name(Arguments... arguments) {          \
    return alive<N>() ? instead : hn::name(arguments...); \
  }

#define SUREFILL_VECTOR_SWAP(one, other)               \
  SUREFILL_VECTOR_MUTANT(one, hn::other(arguments...)) \
  SUREFILL_VECTOR_MUTANT(other, hn::one(arguments...))

SUREFILL_VECTOR_SWAP(Add, Sub)
SUREFILL_VECTOR_SWAP(Min, Max)
SUREFILL_VECTOR_MUTANT(Lt, less_or_equal(arguments...))
SUREFILL_VECTOR_MUTANT(Le, hn::Lt(arguments...))
SUREFILL_VECTOR_MUTANT(Gt, greater_or_equal(arguments...))
SUREFILL_VECTOR_MUTANT(Ge, hn::Gt(arguments...))
SUREFILL_VECTOR_SWAP(Eq, Ne)
SUREFILL_VECTOR_SWAP(And, Or)
SUREFILL_VECTOR_SWAP(Floor, Ceil)
SUREFILL_VECTOR_SWAP(InterleaveLower, InterleaveUpper)
SUREFILL_VECTOR_SWAP(MinOfLanes, MaxOfLanes)
SUREFILL_VECTOR_SWAP(IfThenZeroElse, IfThenElseZero)
SUREFILL_VECTOR_MUTANT(Mul, hn::Add(arguments...))
SUREFILL_VECTOR_MUTANT(Div, hn::Mul(arguments...))
SUREFILL_VECTOR_MUTANT(Xor, hn::And(arguments...))
SUREFILL_VECTOR_MUTANT(AndNot, hn::And(arguments...))
SUREFILL_VECTOR_MUTANT(Round, hn::Floor(arguments...))
SUREFILL_VECTOR_MUTANT(AllFalse, !hn::AllFalse(arguments...))

#undef SUREFILL_VECTOR_SWAP
#undef SUREFILL_VECTOR_MUTANT

// What changes the sign, or all bits, does nothing.
#define SUREFILL_VECTOR_IDENTITY(name)           \
  template <unsigned N, class Value>             \
  HWY_INLINE Value name(Value value) {           \
    return alive<N>() ? value : hn::name(value); \
  }

SUREFILL_VECTOR_IDENTITY(Abs)
SUREFILL_VECTOR_IDENTITY(Neg)
SUREFILL_VECTOR_IDENTITY(Not)

#undef SUREFILL_VECTOR_IDENTITY

// The other one of two.
template <unsigned N, class Mask, class Value>
HWY_INLINE Value IfThenElse(Mask mask, Value yes, Value no) {
  return alive<N>() ? hn::IfThenElse(mask, no, yes) : hn::IfThenElse(mask, yes, no);
}
template <unsigned N, class D, class Half>
HWY_INLINE auto Combine(D d, Half high, Half low) {
  return alive<N>() ? hn::Combine(d, low, high) : hn::Combine(d, high, low);
}

// One bit more.
template <unsigned N, int kBits, class Value>
HWY_INLINE Value ShiftLeft(Value value) {
  return alive<N>() ? hn::ShiftLeft<kBits + 1>(value) : hn::ShiftLeft<kBits>(value);
}

}  // namespace surefill::mutant

#endif  // SUREFILL_PROPERTIES_SCHEMATA_VECTOR_MUTANT_HPP
