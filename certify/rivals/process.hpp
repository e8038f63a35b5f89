// SPDX-License-Identifier: Apache-2.0
//
// A rival's process: started, asked, watched and ended. Whatever it does, the caller gets an answer in time.
#ifndef SUREFILL_CERTIFY_ADAPTERS_PROCESS_HPP
#define SUREFILL_CERTIFY_ADAPTERS_PROCESS_HPP

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "certify/rivals/wire.hpp"

namespace surefill::adapters {

// What a request came to. `failure` set: there is no answer, because the process ended, hung or spoke nonsense.
struct Answer {
  std::uint32_t status = SUREFILL_ADAPTER_FAILED;
  Words words;
  std::string failure;
  bool timed_out = false;
};

// Not thread-safe; different processes may be used at once. What the process prints on stderr is kept, and its end is
// quoted where it fails.
class Process {
 public:
  // Starts it, found through PATH. Throws std::runtime_error.
  explicit Process(const std::vector<std::string>& command);
  ~Process();  // asks it to close, gives it a moment, and kills it with all its children
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // After a failure the process is dead, and asking again is an error of the caller. An answer of more than
  // `most_words` is nonsense.
  Answer ask(std::uint32_t kind, const Words& body, std::size_t most_words, std::chrono::milliseconds limit);
  bool alive() const { return pid_ > 0; }

 private:
  std::string fail(const std::string& what);
  std::string end_of_process();
  void read_errors();
  void close_pipes();
  void kill_and_wait();

  pid_t pid_ = -1;
  int input_ = -1, output_ = -1, errors_ = -1;  // its stdin, stdout and stderr, our ends
  std::string error_text_;
};

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_PROCESS_HPP
