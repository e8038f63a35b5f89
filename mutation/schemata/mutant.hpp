// SPDX-License-Identifier: Apache-2.0
//
// Mutant schemata: every mutant of the engine is compiled in, and one, chosen at run time, is alive. An operator
// between two operands becomes itself on either side of a marker, so that precedence stays:  a + b  is  a + Marked<7>{}
// + b. Operands are values: a reference may be bound to an element beyond an array's end unnoticed.
#ifndef SUREFILL_PROPERTIES_SCHEMATA_MUTANT_HPP
#define SUREFILL_PROPERTIES_SCHEMATA_MUTANT_HPP

#include <type_traits>

namespace surefill::mutant {

inline unsigned number = 0;  // of the mutant that is alive; 0: none

template <unsigned N>
bool alive() {
  return number == N;
}

template <unsigned N>
struct Marked {};

template <class Value, unsigned N>
struct Left {
  Value value;
};

// An address before a table is one that the compiler must not think impossible.
template <class Value>
Value hidden(Value value) {
  if constexpr (std::is_pointer_v<Value>) asm volatile("" : "+r"(value));
  return value;
}

#define SUREFILL_MUTANT_OPERATOR(op, instead)                                                        \
  template <class Value, unsigned N>                                                                 \
  Left<Value, N> operator op(Value value, Marked<N>) {                                               \
    return {value};                                                                                  \
  }                                                                                                  \
  template <class Value, unsigned N, class Right>                                                    \
  auto operator op(Left<Value, N> left, Right right) {                                               \
    using Result = decltype(left.value op right);                                                    \
    return alive<N>() ? hidden(static_cast<Result>(left.value instead right)) : left.value op right; \
  }

SUREFILL_MUTANT_OPERATOR(+, -)
SUREFILL_MUTANT_OPERATOR(-, +)
SUREFILL_MUTANT_OPERATOR(*, +)
SUREFILL_MUTANT_OPERATOR(<, <=)
SUREFILL_MUTANT_OPERATOR(<=, <)
SUREFILL_MUTANT_OPERATOR(>, >=)
SUREFILL_MUTANT_OPERATOR(>=, >)
SUREFILL_MUTANT_OPERATOR(==, !=)
SUREFILL_MUTANT_OPERATOR(!=, ==)
SUREFILL_MUTANT_OPERATOR(&, |)
SUREFILL_MUTANT_OPERATOR(|, &)
SUREFILL_MUTANT_OPERATOR(<<, >>)
SUREFILL_MUTANT_OPERATOR(>>, <<)

#undef SUREFILL_MUTANT_OPERATOR

}  // namespace surefill::mutant

using surefill::mutant::Marked;

#endif  // SUREFILL_PROPERTIES_SCHEMATA_MUTANT_HPP
