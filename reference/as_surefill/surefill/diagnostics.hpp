// SPDX-License-Identifier: Apache-2.0
#include "reference/as_surefill/surefill/surefill.hpp"
