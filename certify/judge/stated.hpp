// SPDX-License-Identifier: Apache-2.0
//
// May a model that somebody states be the one that probing finds?
#ifndef SUREFILL_CERTIFY_JUDGE_STATED_HPP
#define SUREFILL_CERTIFY_JUDGE_STATED_HPP

#include "oracle/model.hpp"

namespace surefill::judge {

// The same rasterizer in other words, if there are some: samples moved instead of the picture (R2, R3).
oracle::Model in_plain_words(oracle::Model model);

// Do they contradict each other nowhere? Probing finds places and blur with a margin, and does not see who owns the samples on
// edges where no vertex comes to lie on a sample. Facts (with_facts), lines and points are not compared.
bool may_be(const oracle::Model& stated, const oracle::Model& found);

// Can the owners of edges be seen, samples lying where vertices come to lie, as far as that is stated?
bool owners_are_seen(const oracle::Model& stated);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_STATED_HPP
