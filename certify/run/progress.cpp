// SPDX-License-Identifier: Apache-2.0
#include "certify/run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>

namespace surefill::certify {

namespace {

std::atomic<bool> interrupt_seen = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // so a signal handler may touch it

extern "C" void note_interrupt(int signal) {
  if (interrupt_seen.exchange(true)) _exit(128 + signal);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
}

bool interrupted() {
  return interrupt_seen;
}

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()), last_() {}

void Progress::show(const std::string& what, double done, double total) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (visible_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double share = total > 0 ? done / total : 1;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string left;
  if (elapsed > 1 && share > 0.01) {
    const double seconds = elapsed * (1 - share) / share;
    left = seconds < 90 ? fmt::format(", about {:.0f} s left", seconds)
                        : fmt::format(", about {:.0f} min left", seconds / 60);
  }
  const std::string line = fmt::format("{:3.0f} %  {}{}", share * 100, what, left);
  std::fprintf(stderr, "\r\033[K%s", line.substr(0, 78).c_str());
  std::fflush(stderr);
  visible_ = true;
}

void Progress::clear() {
  if (!visible_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace surefill::certify
