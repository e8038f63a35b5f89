// SPDX-License-Identifier: Apache-2.0
//
// `surefill certify` and `surefill merge`: options, and what they do; and how a rival is named on any command line.
#ifndef SUREFILL_CERTIFY_CERTIFY_COMMAND_HPP
#define SUREFILL_CERTIFY_CERTIFY_COMMAND_HPP

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "certify/rivals/rival.hpp"
#include "certify/run/checks.hpp"

namespace surefill::certify {

// Exit statuses of every subcommand.
inline constexpr int kGood = 0, kBad = 1, kUsage = 2, kInterrupted = 130;

// Wrong usage or input that cannot be used. what() is one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Somebody else's rasterizer, as options.
struct RivalChoice {
  std::string plugin, adapter, arguments, command;
  double time_limit = 5;  // seconds for a scene

  bool chosen() const { return !plugin.empty() || !adapter.empty() || !command.empty(); }
  std::string as_options() const;          // as a shell takes them
  std::vector<std::string> files() const;  // what may be a file of the rasterizer, so that no output goes there
};
void add_rival_options(CLI::App& app, RivalChoice& choice);
// The words of a command, as a shell splits them. Throws UsageError where a quotation mark is left open, or without any.
std::vector<std::string> words_of(const std::string& command);

// Starts it. Throws UsageError where it cannot be started or opened.
std::unique_ptr<adapters::Rival> start_rival(const RivalChoice& choice);

struct CertifyOptions {
  std::string level = "quick", json, junit, html, resume, shard, output_directory = ".", corpus;
  std::vector<std::string> only;
  std::uint64_t seed = 1;
  int jobs = 1;
  bool list = false;
  std::optional<std::uint64_t> only_case;  // of the one check that is named
  RivalChoice rival;
};
void add_certify_options(CLI::App& app, CertifyOptions& options);
// "quick", "standard" or "thorough".
Level level_named(const std::string& name);
// `find_corpus` is asked where no corpus is named.
int run_certify(const CertifyOptions& options, const std::function<std::string()>& find_corpus);

struct MergeOptions {
  std::vector<std::string> shards;
  std::string json, junit, html;
};
void add_merge_options(CLI::App& app, MergeOptions& options);
int run_merge(const MergeOptions& options);

// What `surefill --version` says: version and commit in the first line; then compiler, path and processor, the drivers'
// adapters that are there, the corpus.
std::string version_text(const std::string& corpus);

// To stdout. Throws FileError.
void print(const std::string& text);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_CERTIFY_COMMAND_HPP
