// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace surefill::adapters {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostErrorText = 400;  // characters of stderr that are kept

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(fmt::format("pipe: {}", std::strerror(errno)));
  return ends;
}

void close_end(int& end) {
  if (end >= 0) ::close(end);
  end = -1;
}

void make_nonblocking(int end) {
  ::fcntl(end, F_SETFL, ::fcntl(end, F_GETFL) | O_NONBLOCK);
}

int milliseconds_until(Clock::time_point time) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now()).count();
  return static_cast<int>(std::clamp<long>(left, 0, 1000000));
}

// The last lines that say something, as one.
std::string last_lines(const std::string& text) {
  constexpr int kMostLines = 3;
  constexpr const char* kBlank = " \t\r";
  std::string result;
  std::size_t end = text.size();
  for (int lines = 0; lines < kMostLines && end != std::string::npos;) {
    const std::size_t newline = end == 0 ? std::string::npos : text.find_last_of('\n', end - 1);
    const std::size_t begin = newline == std::string::npos ? 0 : newline + 1;
    std::string line = text.substr(begin, end - begin);
    line.erase(0, std::min(line.find_first_not_of(kBlank), line.size()));
    line.resize(line.find_last_not_of(kBlank) + 1);
    for (char& c : line) {
      if (static_cast<unsigned char>(c) < 32) c = ' ';
    }
    // Python marks the place in the line above by "^^^^".
    if (line.find_first_not_of("^~ ") != std::string::npos) {
      result = line + (lines++ == 0 ? "" : " | ") + result;
    }
    end = newline;
  }
  return result;
}

}  // namespace

Process::Process(const std::vector<std::string>& command) {
  std::signal(SIGPIPE, SIG_IGN);
  std::array<int, 2> in = make_pipe(), out = make_pipe(), err = make_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  posix_spawn_file_actions_adddup2(&actions, err[1], 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A group of its own, so that its children end with it and Ctrl-C does not reach it; signals as a new program has
  // them.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int error = ::posix_spawnp(&pid_, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  for (int* end : {&in[0], &out[1], &err[1]}) close_end(*end);
  input_ = in[1];
  output_ = out[0];
  errors_ = err[0];
  if (error != 0) {
    pid_ = -1;
    close_pipes();
    throw std::runtime_error(fmt::format("{}: cannot be started: {}", command[0], std::strerror(error)));
  }
  for (const int end : {input_, output_, errors_}) make_nonblocking(end);
}

Process::~Process() {
  if (pid_ <= 0) return;
  const std::uint32_t close_request[kHeaderWords] = {kClose, 0};
  [[maybe_unused]] const ssize_t written = ::write(input_, close_request, sizeof close_request);
  close_end(input_);
  for (int n = 0; n < 100; ++n) {
    if (::waitpid(pid_, nullptr, WNOHANG) == pid_) {
      ::kill(-pid_, SIGKILL);  // children that it left
      pid_ = -1;
      break;
    }
    read_errors();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill_and_wait();
  close_pipes();
}

void Process::close_pipes() {
  for (int* end : {&input_, &output_, &errors_}) close_end(*end);
}

void Process::kill_and_wait() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

void Process::read_errors() {
  std::array<char, 1024> buffer{};
  for (ssize_t n = 0; (n = ::read(errors_, buffer.data(), buffer.size())) > 0;) {
    error_text_.append(buffer.data(), static_cast<std::size_t>(n));
    if (error_text_.size() > kMostErrorText) error_text_.erase(0, error_text_.size() - kMostErrorText);
  }
}

// How the process ended; it has closed its stdout, so it ends now or is killed.
std::string Process::end_of_process() {
  int status = 0;
  bool ended = false;
  for (int n = 0; n < 100 && !ended; ++n) {
    ended = ::waitpid(pid_, &status, WNOHANG) == pid_;
    if (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!ended) return "closed its standard output without ending";
  ::kill(-pid_, SIGKILL);
  pid_ = -1;
  if (WIFSIGNALED(status))
    return fmt::format("was ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

std::string Process::fail(const std::string& what) {
  read_errors();
  kill_and_wait();
  const std::string said = last_lines(error_text_);
  close_pipes();
  return "the rasterizer " + what + (said.empty() ? "" : "; it said: " + said);
}

Answer Process::ask(std::uint32_t kind, const Words& body, std::size_t most_words, std::chrono::milliseconds limit) {
  const Clock::time_point deadline = Clock::now() + limit;
  Words request{kind, static_cast<std::uint32_t>(body.size())};
  request.insert(request.end(), body.begin(), body.end());
  const char* rest = reinterpret_cast<const char*>(request.data());
  std::size_t left = request.size() * 4;
  Answer answer;
  std::array<std::uint32_t, kHeaderWords> header{};
  std::size_t got = 0;  // bytes of header and words
  const auto expected = [&] { return 4 * (kHeaderWords + answer.words.size()); };
  while (left > 0 || got < expected()) {
    std::array<pollfd, 3> watched{{{output_, POLLIN, 0}, {errors_, POLLIN, 0}, {input_, POLLOUT, 0}}};
    const int ready = ::poll(watched.data(), left > 0 ? 3 : 2, milliseconds_until(deadline));
    if (ready < 0 && errno != EINTR) throw std::runtime_error(fmt::format("poll: {}", std::strerror(errno)));
    if (ready == 0) {
      answer.timed_out = true;
      answer.failure =
          fail(fmt::format("gave no answer within {:.3g} s", std::chrono::duration<double>(limit).count()));
      return answer;
    }
    if (ready < 0) continue;
    if (watched[1].revents != 0) read_errors();
    if (left > 0 && watched[2].revents != 0) {
      const ssize_t n = ::write(input_, rest, left);
      if (n > 0) {
        rest += n;
        left -= static_cast<std::size_t>(n);
      } else if (errno != EAGAIN && errno != EINTR) {
        answer.failure = fail(end_of_process());
        return answer;
      }
    }
    if (watched[0].revents == 0) {
      // A closed stderr would wake poll for ever.
      if (watched[1].revents & POLLHUP) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    const bool in_header = got < 4 * kHeaderWords;
    char* place = in_header ? reinterpret_cast<char*>(header.data()) + got
                            : reinterpret_cast<char*>(answer.words.data()) + (got - 4 * kHeaderWords);
    const std::size_t room = (in_header ? 4 * kHeaderWords : expected()) - got;
    const ssize_t n = room == 0 ? 1 : ::read(output_, place, room);
    if (room == 0) {
      answer.failure = fail("answered before it had read the request");
      return answer;
    }
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) {
      answer.failure = fail(end_of_process());
      return answer;
    }
    if (n < 0) continue;
    got += static_cast<std::size_t>(n);
    if (!in_header || got < 4 * kHeaderWords) continue;
    answer.status = header[0];
    const std::size_t most = answer.status == SUREFILL_ADAPTER_OK ? most_words : 1024;
    if (header[0] > SUREFILL_ADAPTER_FAILED || header[1] > most) {
      answer.failure = fail(fmt::format("answered no message: status {}, {} words, where at most {} are due", header[0],
                                        header[1], most));
      return answer;
    }
    answer.words.resize(header[1]);
  }
  return answer;
}

}  // namespace surefill::adapters
