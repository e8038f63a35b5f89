// SPDX-License-Identifier: Apache-2.0
//
// Thirty more faults, written by somebody who had not read how faults are named: what naming is worth is measured on
// them, and nothing is tuned to them.
#ifndef SUREFILL_MUTATION_ZOO_FURTHER_HPP
#define SUREFILL_MUTATION_ZOO_FURTHER_HPP

#include "mutation/zoo/zoo.hpp"

namespace surefill::zoo {

struct FurtherFault {
  const char* name;
  const char* fault;     // one line: what it does
  const char* kind;      // of public bug
  const char* must_say;  // a name is right if it holds one of these, separated by |; written before any was measured
  Status (*render)(const Target& target, Draws draws);
};

std::span<const FurtherFault> further_faults();

}  // namespace surefill::zoo

#endif  // SUREFILL_MUTATION_ZOO_FURTHER_HPP
