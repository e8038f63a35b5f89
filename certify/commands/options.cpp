// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <utility>

namespace surefill::certify {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& value, const std::string& expected) {
  constexpr std::size_t kShown = 40;
  const std::string shown = value.size() > kShown ? value.substr(0, kShown) + "..." : value;
  throw CLI::ValidationError(option + " " + shown, "expected " + expected);
}

// All of the text as a number. A sign or a point where the type has none, a blank, another base: none.
template <typename Number>
bool parse(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

void refuse_empty_values_of(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    // Before other checks, which would say other things.
    option->transform(CLI::Validator(
        [](std::string& value) { return value.empty() ? std::string("an empty value") : std::string(); }, ""));
  }
  for (CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
    refuse_empty_values_of(*subcommand);
  }
}

}  // namespace

CLI::Option* add_whole_number(CLI::App& app, const std::string& name, std::uint64_t least, std::uint64_t most,
                              const std::function<void(std::uint64_t)>& take, const std::string& text) {
  const auto read = [=](const std::string& value) {
    std::uint64_t number = 0;
    if (!parse(value, number) || number < least || number > most) {
      refuse(name, value, fmt::format("a whole number from {} to {}", least, most));
    }
    take(number);
  };
  return app.add_option_function<std::string>(name, read, text)->type_name("NUMBER");
}

CLI::Option* add_decimal(CLI::App& app, const std::string& name, double least, double most,
                         const std::function<void(double)>& take, const std::string& text) {
  const auto read = [=](const std::string& value) {
    double number = 0;
    // Written so that NaN is refused.
    if (!parse(value, number) || !(number >= least && number <= most)) {
      refuse(name, value, fmt::format("a number from {} to {}", least, most));
    }
    take(number);
  };
  return app.add_option_function<std::string>(name, read, text)->type_name("NUMBER");
}

void refuse_empty_values(CLI::App& app, int argc, const char* const* argv) {
  refuse_empty_values_of(app);
  for (int n = 1; n < argc; ++n) {
    const std::string_view argument = argv[n];
    if (argument == "--") break;
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1) {
      throw CLI::ValidationError(std::string(argument.substr(0, argument.size() - 1)), "an empty value");
    }
  }
}

CLI::Option* add_names(CLI::App& app, const std::string& name, std::vector<std::string>& names,
                       const std::string& text) {
  const auto read = [name, &names](const std::vector<std::string>& lists) {
    for (const std::string& list : lists) {
      std::vector<std::string> words = CLI::detail::split(list, ',');
      if (list.ends_with(',')) words.emplace_back();  // split leaves it out
      for (std::string& word : words) {
        if (word.empty()) throw CLI::ValidationError(name + " " + list, "an empty name between commas");
        names.push_back(std::move(word));
      }
    }
  };
  return app.add_option_function<std::vector<std::string>>(name, read, text);
}

}  // namespace surefill::certify
