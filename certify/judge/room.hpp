// SPDX-License-Identifier: Apache-2.0
//
// What the page's judge, which every visitor loads, has no room for.
#ifndef SUREFILL_CERTIFY_JUDGE_ROOM_HPP
#define SUREFILL_CERTIFY_JUDGE_ROOM_HPP

namespace surefill::judge {

// Are the questions asked, too, that cost the most code for the fewest faults?
#ifdef SUREFILL_PAGE
inline constexpr bool kAsksAll = false;
#else
inline constexpr bool kAsksAll = true;
#endif

}  // namespace surefill::judge

#endif  // SUREFILL_CERTIFY_JUDGE_ROOM_HPP
