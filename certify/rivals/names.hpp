// SPDX-License-Identifier: Apache-2.0
//
// What a rival's fault is called, by the zoo's specimens.
#ifndef SUREFILL_CERTIFY_RIVAL_NAMES_HPP
#define SUREFILL_CERTIFY_RIVAL_NAMES_HPP

#include <span>
#include <string>
#include <vector>

#include "certify/judge/naming.hpp"
#include "certify/judge/questions.hpp"
#include "certify/judge/which.hpp"
#include "certify/rivals/rival_cases.hpp"

namespace surefill::certify {

// The specimens of the zoo.
std::span<const judge::Fault> known_faults();

// Of a rival whose model section 6 has, scenes on which it is wrong: those given, and some random ones. At most `most`.
// `fine` gets random ones that it draws right.
std::vector<judge::Wrong> wrong_scenes(const RivalSubject& subject, std::span<const corpus::Scene> found,
                                       std::size_t most, std::vector<corpus::Scene>& fine);

// What is wrong with it in sentences, the most telling first, at most three: a known fault that draws nine tenths of it,
// what all of it has in common, a known fault that draws most of it. `fine` and `trials` as of judge::symptoms.
std::vector<std::string> sentences_of(std::span<const judge::Name> names, std::span<const judge::Wrong> wrong,
                                      std::span<const corpus::Scene> fine, const judge::Trials& trials);

// Of a rival: what asking it says (judge::ask), then the same of scenes on which it is wrong. Where no model is known, plain
// triangles are these scenes.
std::vector<std::string> explain_rival(const RivalSubject& subject, std::span<const corpus::Scene> found);

// Of one that dies again and again: on which targets.
std::vector<std::string> explain_deaths(const RivalSubject& subject);

// "samples on edges belong to both sides (agrees on 97 % of what is wrong; edges-inclusive, seen in ...)".
std::string name_text(const judge::Name& name);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVAL_NAMES_HPP
