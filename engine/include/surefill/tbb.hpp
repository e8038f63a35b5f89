// SPDX-License-Identifier: Apache-2.0
//
// Draws on oneTBB's threads: render(target, draws, nullptr, {.threads = 8, .executor = surefill::tbb_executor()}).
// Header only; installed where SUREFILL_TBB is ON, with the CMake target surefill::tbb.
#ifndef SUREFILL_TBB_HPP
#define SUREFILL_TBB_HPP

#include <oneapi/tbb/parallel_for.h>

#include <cstddef>

#include "surefill/surefill.hpp"

namespace surefill {

// An executor over tbb::parallel_for in the caller's arena. Options::threads says into how many parts work is divided.
inline Executor tbb_executor() {
  const auto run = [](void*, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
    oneapi::tbb::parallel_for(std::size_t{0}, items, [=](std::size_t item) { task(argument, item); });
  };
  return {run, nullptr};
}

}  // namespace surefill

#endif  // SUREFILL_TBB_HPP
