// SPDX-License-Identifier: Apache-2.0
//
// What the options of all subcommands have in common: no value is empty, and every number is decimal and has a range.
#ifndef SUREFILL_CERTIFY_OPTIONS_HPP
#define SUREFILL_CERTIFY_OPTIONS_HPP

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace surefill::certify {

// An option whose value is a whole number from `least` to `most`, given to `take`.
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, std::uint64_t least, std::uint64_t most,
                              const std::function<void(std::uint64_t)>& take, const std::string& text);

template <typename Integer>
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, Integer& value, std::uint64_t least,
                              std::uint64_t most, const std::string& text) {
  return add_whole_number(
      app, name, least, most, [&value](std::uint64_t number) { value = static_cast<Integer>(number); }, text);
}

// The same for a decimal that lies between the two, or at one of them.
CLI::Option* add_decimal(CLI::App& app, const std::string& name, double least, double most,
                         const std::function<void(double)>& take, const std::string& text);

// To be called when all options are there and before the arguments are parsed: from then on each option of each
// subcommand refuses the empty value. Throws CLI::ParseError for `--option=`, which would take the next argument.
void refuse_empty_values(CLI::App& app, int argc, const char* const* argv);

// An option of several names, separated by commas, or given several times. None is empty.
CLI::Option* add_names(CLI::App& app, const std::string& name, std::vector<std::string>& names,
                       const std::string& text);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_OPTIONS_HPP
