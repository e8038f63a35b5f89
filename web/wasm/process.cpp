// SPDX-License-Identifier: Apache-2.0
//
// The rasterizer under test is no process here: the page's JavaScript answers the same requests.
#include "certify/rivals/process.hpp"

#include <cstdlib>
#include <cstring>
#include <memory>

#include "web/wasm/page.hpp"

namespace surefill::adapters {

namespace {

struct Free {
  void operator()(std::uint32_t* words) const { std::free(words); }
};

// How the answer begins.
enum Outcome : std::uint32_t { kAnswered, kEnded, kTimedOut };
constexpr std::size_t kHeader = 3;  // outcome, status, words that follow

}  // namespace

Process::Process(const std::vector<std::string>&) : pid_(1) {}
Process::~Process() = default;

Answer Process::ask(std::uint32_t kind, const Words& body, std::size_t most_words, std::chrono::milliseconds limit) {
  const std::unique_ptr<std::uint32_t, Free> words(
      surefill_ask(kind, body.data(), body.size(), most_words, static_cast<double>(limit.count())));
  const std::uint32_t* at = words.get();
  Answer answer;
  answer.status = at[1];
  answer.words.assign(at + kHeader, at + kHeader + at[2]);
  if (at[0] == kAnswered) return answer;
  answer.timed_out = at[0] == kTimedOut;
  answer.failure = text_of(answer.words);
  return answer;
}

}  // namespace surefill::adapters
