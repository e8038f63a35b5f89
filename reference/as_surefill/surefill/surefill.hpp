// SPDX-License-Identifier: Apache-2.0
//
// The one file in the place of the engine's headers: what is written for the engine is compiled against it.
#ifndef SUREFILL_REFERENCE_AS_SUREFILL_HPP
#define SUREFILL_REFERENCE_AS_SUREFILL_HPP

#include "reference/surefill_reference.h"

namespace surefill {
using namespace surefill_reference;
}

#endif  // SUREFILL_REFERENCE_AS_SUREFILL_HPP
