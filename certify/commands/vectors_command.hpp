// SPDX-License-Identifier: Apache-2.0
//
// `surefill vectors` and `surefill verify`: the files of vectors/, made, printed as text, and results held against them.
#ifndef SUREFILL_CERTIFY_VECTORS_COMMAND_HPP
#define SUREFILL_CERTIFY_VECTORS_COMMAND_HPP

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace surefill::certify {

struct VectorsOptions {
  std::string folder;             // of the files; empty: where they lie
  std::vector<std::string> make;  // subjects to make anew; "all"
  std::string markdown;           // a page that gets the tables
  std::string text;               // a subject, printed as text
  int jobs = 1;
};
CLI::App* add_vectors_command(CLI::App& app, VectorsOptions& options);

// Exit status. `corpus` finds the corpus.
int run_vectors(VectorsOptions options, const std::function<std::string()>& corpus);

struct VerifyOptions {
  std::string results;  // a file; empty: standard input
  bool text = false;
  std::string folder;
};
CLI::App* add_verify_command(CLI::App& app, VerifyOptions& options);
int run_verify(VerifyOptions options, const std::function<std::string()>& corpus);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_VECTORS_COMMAND_HPP
