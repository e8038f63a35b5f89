// SPDX-License-Identifier: Apache-2.0
//
// The model that a rival of version 2 states, in the words of its adapter and in those of section 11.
#ifndef SUREFILL_CERTIFY_ADAPTERS_STATED_MODEL_HPP
#define SUREFILL_CERTIFY_ADAPTERS_STATED_MODEL_HPP

#include <string>

#include "certify/adapter2.h"
#include "oracle/model.hpp"

namespace surefill::adapters {

// The defaults of section 11: the exact model, under the top-left rule.
surefill_adapter2_model default_model();

// The same; section 11's. What is wrong with the numbers, as a sentence; empty if nothing.
std::string take_model(const surefill_adapter2_model& from, oracle::Model& to);

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_STATED_MODEL_HPP
