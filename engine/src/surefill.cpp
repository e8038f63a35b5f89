// SPDX-License-Identifier: Apache-2.0
//
// The public calls: check the arguments, set the floating-point state, take the path.
#include "surefill/surefill.hpp"

#include <algorithm>

#include "arguments.hpp"
#include "build_check.hpp"
#include "callers_code.hpp"
#include "facts.hpp"
#include "fast/frame.hpp"
#include "fast/memory.hpp"
#include "float_environment.hpp"
#include "reference.hpp"
#include "statistics.hpp"
#include "surefill/diagnostics.hpp"
#if !defined(SUREFILL_REFERENCE_ONLY)
#include "streamed.hpp"
#endif

namespace surefill {
namespace {

// The standard sample locations of Direct3D 11 and Vulkan (S4), in 1/16 pixel.
constexpr SampleLocation kLocations1[] = {{8, 8}};
constexpr SampleLocation kLocations2[] = {{12, 12}, {4, 4}};
constexpr SampleLocation kLocations4[] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
constexpr SampleLocation kLocations8[] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
constexpr SampleLocation kLocations16[] = {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                                           {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};

// Does somebody ask for an output of samples or of triangles?
bool asks_for_outputs(const Target& target, std::span<const Draw> draws) {
  const bool numbers = std::any_of(draws.begin(), draws.end(),
                                   [](const Draw& draw) { return !draw.covered.empty() || !draw.visible.empty(); });
  return wanted_outputs(target).depth || !target.count.empty() || !target.winding.empty() || numbers;
}

// Neither is inlined: they need the engine's floating-point state.
[[gnu::noinline]] Status draw(const Target& target, std::span<const Draw> draws,
                              [[maybe_unused]] const Options& options, Diagnostics& diagnostics) {
#if !defined(SUREFILL_REFERENCE_ONLY)
  if (options.path == Path::automatic && fast::supports(target, draws)) {
    return fast::render(target, draws, options, diagnostics);
  }
  if (options.path == Path::automatic && streamed::supports(target, draws)) {
    return streamed::render(target, draws, options, diagnostics);
  }
#endif
  diagnostics.path = "reference";
  return reference::render(target, draws, diagnostics.rungs);
}

[[gnu::noinline]] Status visit(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                               [[maybe_unused]] const Options& options, Diagnostics& diagnostics) {
#if !defined(SUREFILL_REFERENCE_ONLY)
  if (options.path == Path::automatic && fast::supports(target, draws)) {
    return fast::visit_coverage(target, draws, visitor, options, diagnostics);
  }
#endif
  diagnostics.path = "reference";
  return reference::visit_coverage(target, draws, visitor, diagnostics.rungs);
}

// What is asked for beside the image.
[[gnu::noinline]] void report(std::span<const Draw> draws, Statistics* statistics, const Options& options,
                              const Diagnostics& diagnostics) {
  if (statistics != nullptr) *statistics = statistics_of(draws);
  if (options.diagnostics != nullptr) *options.diagnostics = diagnostics;
}

}  // namespace

Context::Context() noexcept = default;

Context::~Context() {
#if !defined(SUREFILL_REFERENCE_ONLY)
  const fast::BorrowedMemory last(*this);
#endif
}

SampleLocation sample_location(int samples, int n) noexcept {
  if (n < 0 || n >= samples) n = 0;
  switch (samples) {
    case 2:
      return kLocations2[n];
    case 4:
      return kLocations4[n];
    case 8:
      return kLocations8[n];
    case 16:
      return kLocations16[n];
    default:
      return kLocations1[0];
  }
}

Status render(const Target& target, std::span<const Draw> draws, Statistics* statistics) noexcept {
  return render(target, draws, statistics, {});
}

Status render(const Target& target, std::span<const Draw> draws, Statistics* statistics,
              const Options& options) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  if (const Status status = check_call(target, draws, statistics, options); status != Status::ok) return status;
  FloatEnvironment environment;
  CallersCode callers{environment, options.executor, {}};
  Diagnostics diagnostics;
  const Status status = draw(target, draws, callers.with_executor(options), diagnostics);
  if (status == Status::ok) report(draws, statistics, options, diagnostics);
  return status;
}

Status visit_coverage(const Target& target, std::span<const Draw> draws, const CoverageVisitor& visitor,
                      Statistics* statistics, const Options& options) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  if (const Status status = check_call(target, draws, statistics, options); status != Status::ok) return status;
  if (asks_for_outputs(target, draws) || target.layers != 1) return Status::target_outputs;
  if (visitor.visit == nullptr) return Status::visitor;
  FloatEnvironment environment;
  CallersCode callers{environment, options.executor, visitor};
  Diagnostics diagnostics;
  const Status status =
      visit(target, draws, {CallersCode::visit_blocks, &callers}, callers.with_executor(options), diagnostics);
  if (status == Status::ok) report(draws, statistics, options, diagnostics);
  return status;
}

}  // namespace surefill
