// SPDX-License-Identifier: Apache-2.0
//
// What naming is worth: of faults that are known, how many are called what they are?
#ifndef SUREFILL_MUTATION_CALLED_HPP
#define SUREFILL_MUTATION_CALLED_HPP

#include <functional>
#include <string>

namespace surefill::mutation {

// Names each specimen of the zoo by all of them, and the further faults, which no name was made for (zoo/further.hpp);
// prints a line for each. True if nine in ten of the former and seven in ten of the latter are called what they are.
bool zoo_names(const std::function<void(const std::string&)>& print);

}  // namespace surefill::mutation

#endif  // SUREFILL_MUTATION_CALLED_HPP
