// SPDX-License-Identifier: Apache-2.0
#ifndef SUREFILL_SRC_CALLERS_CODE_HPP
#define SUREFILL_SRC_CALLERS_CODE_HPP

#include <cstddef>
#include <span>

#include "float_environment.hpp"
#include "surefill/surefill.hpp"

namespace surefill {

// The caller's code, as the engine calls it: in the caller's floating-point state, on whichever thread.
struct CallersCode {
  FloatEnvironment& environment;
  Executor executor;
  CoverageVisitor visitor;

  Options with_executor(Options options) {
    if (executor.run != nullptr) options.executor = {run_tasks, this};
    return options;
  }

  static void run_tasks(void* context, std::size_t items, void (*task)(void*, std::size_t), void* argument) {
    CallersCode& own = *static_cast<CallersCode*>(context);
    own.environment.leave_for([&] { own.executor.run(own.executor.context, items, task, argument); });
  }
  static void visit_blocks(void* context, std::span<const CoverageBlock> blocks) {
    CallersCode& own = *static_cast<CallersCode*>(context);
    own.environment.leave_for([&] { own.visitor.visit(own.visitor.context, blocks); });
  }
};

}  // namespace surefill

#endif  // SUREFILL_SRC_CALLERS_CODE_HPP
