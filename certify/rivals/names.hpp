// SPDX-License-Identifier: Apache-2.0
//
// What a rival's fault is called, by the zoo's specimens.
#ifndef SUREFILL_CERTIFY_RIVAL_NAMES_HPP
#define SUREFILL_CERTIFY_RIVAL_NAMES_HPP

#include <span>
#include <string>
#include <vector>

#include "certify/judge/naming.hpp"
#include "certify/rivals/rival_cases.hpp"

namespace surefill::certify {

// The specimens of the zoo.
std::span<const judge::Fault> known_faults();

// Of a rival whose model section 6 has, scenes on which it is wrong: those given, and some random ones. At most `most`.
std::vector<judge::Wrong> wrong_scenes(const RivalSubject& subject, std::span<const corpus::Scene> found,
                                       std::size_t most);

// The names of what is wrong with it, the best one first.
std::vector<judge::Name> name_rival(const RivalSubject& subject, std::span<const corpus::Scene> found);

// "samples on edges belong to both sides (agrees on 97 % of what is wrong; edges-inclusive, seen in ...)".
std::string name_text(const judge::Name& name);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVAL_NAMES_HPP
