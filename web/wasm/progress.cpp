// SPDX-License-Identifier: Apache-2.0
//
// Progress goes to the page, which may end the run.
#include "certify/run/progress.hpp"

#include "web/wasm/page.hpp"

namespace surefill {

namespace {

bool stop_asked = false;

}  // namespace

namespace certify {

void catch_interrupts() {}

bool interrupted() {
  return stop_asked;
}

Progress::Progress() : terminal_(false) {}

void Progress::show(const std::string&, double, double) {}

void Progress::clear() {}

}  // namespace certify

extern "C" void surefill_stop() {
  stop_asked = true;
}

}  // namespace surefill
