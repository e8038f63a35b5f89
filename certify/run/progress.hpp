// SPDX-License-Identifier: Apache-2.0
//
// A line on a terminal that says how far the work is, and Ctrl-C.
#ifndef SUREFILL_CERTIFY_PROGRESS_HPP
#define SUREFILL_CERTIFY_PROGRESS_HPP

#include <chrono>
#include <string>

namespace surefill::certify {

// From here on SIGINT and SIGTERM only set a flag; a second one ends the process at once.
void catch_interrupts();
bool interrupted();

// One line on stderr, rewritten at most ten times a second; silent where stderr is no terminal. Not thread-safe.
class Progress {
 public:
  Progress();
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `done` of `total` units of estimated work (a share of the time, not of the cases).
  void show(const std::string& what, double done, double total);
  // Takes the line away, before something else is printed.
  void clear();

 private:
  bool terminal_;
  bool visible_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_PROGRESS_HPP
