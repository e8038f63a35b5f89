// SPDX-License-Identifier: Apache-2.0
//
// The rival: Mesa's llvmpipe through OpenGL, without a window.
#ifndef SUREFILL_BENCH_LLVMPIPE_HPP
#define SUREFILL_BENCH_LLVMPIPE_HPP

#include <memory>
#include <span>
#include <string>

#include "bench/workloads.hpp"

namespace surefill::bench {

class Llvmpipe {
 public:
  // Null, and `why` in English, if this machine has no llvmpipe. The number of its threads is LP_NUM_THREADS's: 0 draws
  // on the calling thread.
  static std::unique_ptr<Llvmpipe> open(std::string* why);
  virtual ~Llvmpipe() = default;
  // Takes the vertices, with four floats a vertex more if `values` is not empty, into the driver's buffers.
  virtual void load(const Workload& workload, std::span<const float> values) = 0;
  // Clears and draws what was loaded: a float depth buffer, and with `color` four floats a pixel; waits until it is
  // done.
  virtual void draw(bool color) = 0;
  virtual std::string name() const = 0;
};

}  // namespace surefill::bench

#endif  // SUREFILL_BENCH_LLVMPIPE_HPP
