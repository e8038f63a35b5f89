// SPDX-License-Identifier: Apache-2.0
//
// Numbers in sentences.
#ifndef SUREFILL_CERTIFY_JUDGE_TEXT_HPP
#define SUREFILL_CERTIFY_JUDGE_TEXT_HPP

#include <string>

namespace surefill::judge {

// What printf makes of it, up to 383 bytes. Where the form comes from a table, each form of the table is of the same kinds of
// values as the call.
[[gnu::format(printf, 1, 2)]] std::string text(const char* form, ...);

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_TEXT_HPP
