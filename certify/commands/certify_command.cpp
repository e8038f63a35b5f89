// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/certify_command.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "certify/commands/options.hpp"
#include "certify/report/certificate.hpp"
#include "certify/report/report_files.hpp"
#include "certify/rivals/rival_checks.hpp"
#include "certify/rivals/rival_facts.hpp"
#include "certify/run/checks.hpp"
#include "certify/run/files.hpp"
#include "certify/run/progress.hpp"
#include "certify/run/runner.hpp"

namespace surefill::certify {

namespace {

// The plugin that is built, or installed, beside the command; empty if there is none.
std::filesystem::path plugin_beside(const std::string& adapter, const std::filesystem::path& self) {
  const std::string name = "libsurefill_" + adapter + ".so";
  std::error_code error;
  const std::filesystem::path folder = self.parent_path();
  for (const auto& found : {folder / name, folder.parent_path() / "lib" / "surefill" / name}) {
    if (std::filesystem::is_regular_file(found, error)) return found;
  }
  return {};
}

std::filesystem::path driver_plugin(const std::string& adapter, const std::filesystem::path& self) {
  const std::filesystem::path found = plugin_beside(adapter, self);
  if (!found.empty()) return found;
  const std::string name = "libsurefill_" + adapter + ".so";
  throw UsageError("--adapter " + adapter + ": " + name + " was not built; `./dev certify --adapter " + adapter +
                   "` installs what that needs");
}

Shard shard_of(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const std::size_t slash = text.find('/');
  const auto number = [](std::string_view digits, std::uint64_t& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  const bool good = slash != std::string::npos && number(std::string_view(text).substr(0, slash), shard.index) &&
                    number(std::string_view(text).substr(slash + 1), shard.count) && shard.index >= 1 &&
                    shard.index <= shard.count && shard.count <= 100000;
  if (!good) throw UsageError("--shard " + text + ": expected I/N with 1 <= I <= N, such as 3/8");
  return shard;
}

// The checks whose names match a pattern; every pattern must match one.
std::vector<Check> selected(std::vector<Check> checks, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return checks;
  const auto matches = [](const std::string& pattern, const Check& check) {
    return fnmatch(pattern.c_str(), check.name.c_str(), 0) == 0;
  };
  for (const std::string& pattern : patterns) {
    if (std::none_of(checks.begin(), checks.end(), [&](const Check& check) { return matches(pattern, check); })) {
      throw UsageError("--only " + pattern + ": no check has this name (--list shows them)");
    }
  }
  std::erase_if(checks, [&](const Check& check) {
    return std::none_of(patterns.begin(), patterns.end(),
                        [&](const std::string& pattern) { return matches(pattern, check); });
  });
  return checks;
}

std::vector<OutputFile> reports(const std::string& json, const std::string& junit, const std::string& html) {
  return {{"--json", json, {".json"}}, {"--junit", junit, {".xml"}}, {"--html", html, {".html", ".htm"}}};
}

void write_reports(const Certificate& certificate, const std::string& json, const std::string& junit,
                   const std::string& html) {
  if (!json.empty()) write_file(json, certificate_json(certificate));
  if (!junit.empty()) write_file(junit, junit_report(certificate));
  if (!html.empty()) write_file(html, html_report(certificate));
}

int status_of(const Certificate& certificate) {
  if (certificate.facts.interrupted) return kInterrupted;
  return verdict_of(certificate.results, certificate.facts) == Verdict::certified ? kGood : kBad;
}

// One case, and its scene as the check has it.
int run_case(const Settings& settings, std::span<Check> checks, std::uint64_t number, const std::string& directory) {
  if (checks.size() != 1) throw UsageError("--case needs --only with the name of one check");
  Check& check = checks.front();
  const std::uint64_t cases = check.prepare();
  if (number >= cases) {
    throw UsageError(fmt::format("--case {}: {} has cases 0 to {}", number, check.name, cases - 1));
  }
  if (!check.scene_of) throw UsageError(fmt::format("--case: the cases of {} are no scenes", check.name));
  corpus::Scene scene = check.scene_of(number);
  const CaseResult result = check.run(number);
  const std::string outcome = result.differences > 0 ? result.finding
                              : result.skipped       ? "not applicable"
                                                     : fmt::format("{} samples judged, {} open, 0 differences",
                                                                   grouped(result.samples), grouped(result.open));
  scene.comment = fmt::format("{} ({}): {}\nCase {} of {}, level {}, seed {}, as it is.\n{}", check.name, check.rule,
                              check.claim, number, cases, level_name(settings.level), settings.seed, outcome);
  const std::string path = reserve_path(directory, fmt::format("{}-case-{}", check.name, number), ".scene");
  corpus::write_scene_file(scene, path);
  const std::string option = check.replay_option.empty() ? "" : check.replay_option + " ";
  print(fmt::format("{}, case {} of {}: {}\nsurefill replay {}{}\n", check.name, number, cases, outcome, option,
                    shell_word(path)));
  return result.differences > 0 ? kBad : kGood;
}

}  // namespace

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw FileError("standard output: cannot be written");
  }
}

std::string RivalChoice::as_options() const {
  std::string text;
  if (!plugin.empty()) text = "--plugin " + shell_word(plugin);
  if (!adapter.empty()) text = "--adapter " + adapter;
  if (!command.empty()) text = "--command " + shell_word(command);
  if (!arguments.empty()) text += " --plugin-arguments " + shell_word(arguments);
  return text;
}

std::string version_text(const std::string& corpus) {
  const Facts facts = build_facts();
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::string drivers;
  for (const char* adapter : {"opengl", "vulkan"}) {
    if (!plugin_beside(adapter, self).empty()) drivers += (drivers.empty() ? "" : ", ") + std::string(adapter);
  }
  return fmt::format("{}\ncompiler  {}, {}\nengine    {}, on {}\nadapters  {}\ncorpus    {}", version_line(),
                     facts.compiler, facts.flags, facts.instruction_set, facts.cpu, drivers.empty() ? "none" : drivers,
                     corpus.empty() ? "none" : corpus);
}

void add_rival_options(CLI::App& app, RivalChoice& choice) {
  CLI::Option* plugin = app.add_option("--plugin", choice.plugin, "Another rasterizer: a shared library (adapter.h)");
  CLI::Option* adapter = app.add_option("--adapter", choice.adapter, "A driver of this machine: opengl or vulkan");
  adapter->check(CLI::IsMember({"opengl", "vulkan"}))->excludes(plugin);
  app.add_option("--command", choice.command, "Another rasterizer: a program over stdin and stdout")
      ->excludes(plugin)
      ->excludes(adapter);
  app.add_option("--plugin-arguments", choice.arguments, "What the rasterizer is opened with");
  add_decimal(
      app, "--time-limit", 0.01, 3600, [&choice](double seconds) { choice.time_limit = seconds; },
      "Seconds it may take for one scene (5)");
}

// The words of a command line: split at blanks, with '...', "..." and backslashes as a shell has them, and nothing
// else.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  bool inside = false;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == 0 && (c == ' ' || c == '\t')) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    } else if (c == '\\' && quote != '\'' && i + 1 < text.size()) {
      words.back() += text[++i];
    } else {
      words.back() += c;
    }
  }
  if (quote != 0) throw UsageError("--command: a quotation mark is not closed");
  if (words.empty()) throw UsageError("--command: names no program");
  return words;
}

std::vector<std::string> RivalChoice::files() const {
  std::vector<std::string> named{plugin};
  if (command.empty()) return named;
  for (const std::string& word : words_of(command)) named.push_back(word);
  return named;
}

std::unique_ptr<adapters::Rival> start_rival(const RivalChoice& choice) {
  adapters::RivalOptions options;
  options.arguments = choice.arguments;
  options.time_limit = std::chrono::milliseconds(static_cast<std::int64_t>(choice.time_limit * 1000));
  if (choice.command.empty()) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path plugin =
        choice.adapter.empty() ? std::filesystem::absolute(choice.plugin) : driver_plugin(choice.adapter, self);
    if (!std::filesystem::is_regular_file(plugin, error)) throw UsageError(plugin.string() + ": no such file");
    // A path, so that the loader does not look elsewhere.
    options.command = {self.string(), "plugin-host", plugin.string()};
    if (!choice.arguments.empty()) options.command.push_back(choice.arguments);
  } else {
    options.command = words_of(choice.command);
  }
  try {
    return std::make_unique<adapters::Rival>(std::move(options));
  } catch (const adapters::RivalUnopened& reason) {
    throw UsageError(std::string("nothing to judge: ") + reason.what());
  }
}

void add_certify_options(CLI::App& app, CertifyOptions& options) {
  app.add_option("--level", options.level, "quick (seconds), standard (minutes) or thorough")
      ->check(CLI::IsMember({"quick", "standard", "thorough"}));
  add_whole_number(app, "--seed", options.seed, 0, ~std::uint64_t{0}, "Of the sampled cases (1)");
  add_names(app, "--only", options.only, "Names of checks, with * and ?, separated by commas");
  add_whole_number(
      app, "--case", 0, ~std::uint64_t{0}, [&options](std::uint64_t number) { options.only_case = number; },
      "With --only CHECK: this case alone; its scene goes to --output-dir as it is, right or wrong");
  app.add_flag("--list", options.list, "Name the checks and what they claim; run none");
  add_rival_options(app, options.rival);
  app.add_option("--json", options.json, "Write the certificate there, too, as JSON");
  app.add_option("--junit", options.junit, "The same as JUnit XML");
  app.add_option("--html", options.html, "The same as one page with pictures of the findings");
  app.add_option("--output-dir", options.output_directory, "Folder for reduced scenes (.)");
  add_whole_number(app, "--jobs", options.jobs, 1, 4096, "Threads (all cores)");
  app.add_option("--shard", options.shard, "I/N: part I of N of all cases; `surefill merge` joins them");
  app.add_option("--resume", options.resume, "Keep the state there, and go on from it if it is there");
  app.add_option("--corpus", options.corpus, "Folder of cases/ and meshes/");
}

Level level_named(const std::string& name) {
  return name == "quick" ? Level::quick : name == "standard" ? Level::standard : Level::thorough;
}

int run_certify(const CertifyOptions& options, const std::function<std::string()>& find_corpus) {
  Settings settings;
  settings.level = level_named(options.level);
  settings.seed = options.seed;
  settings.engine = properties::engine_renderer();
  const Shard shard = shard_of(options.shard);
  std::vector<OutputFile> outputs = reports(options.json, options.junit, options.html);
  outputs.push_back({"--resume", options.resume, {}});
  check_outputs(outputs, options.rival.files());
  if (!options.list) {
    settings.corpus = options.corpus.empty() ? find_corpus() : options.corpus;
    check_folder(options.output_directory);
  }
  Facts facts = build_facts();
  facts.level = options.level;
  facts.seed = options.seed;
  facts.jobs = options.jobs;
  facts.shard = shard;

  std::unique_ptr<adapters::Rival> rival;
  RivalSubject subject;
  if (options.rival.chosen()) {
    rival = start_rival(options.rival);
    const surefill_adapter_model declared = rival->info().model;
    subject = meet_rival(*rival);
    if (rival->given_up()) {
      const Certificate certificate = unmet(facts, *rival);
      print(check_line(certificate.results[0], options.seed) + verdict_block(certificate.results, certificate.facts));
      write_reports(certificate, options.json, options.junit, options.html);
      return kBad;
    }
    subject.slow = !options.rival.command.empty();
    subject.replay_option = options.rival.as_options();
    add_rival_facts(subject, declared, facts);
  } else if (!options.list) {
    settings.support = probe_support(settings.engine);
  }
  std::vector<Check> checks =
      selected(rival ? list_rival_checks(settings, subject) : list_checks(settings), options.only);
  if (options.list) {
    for (const Check& check : checks) print(fmt::format("{}: {} [{}]\n", check.name, check.claim, check.rule));
    return kGood;
  }

  if (options.only_case) return run_case(settings, checks, *options.only_case, options.output_directory);

  Certificate earlier;
  std::error_code error;
  if (!options.resume.empty() && std::filesystem::exists(options.resume, error)) {
    earlier = read_certificate_file(options.resume);
    Certificate now{facts, {}};
    for (Check& check : checks) {
      CheckResult& result = now.results.emplace_back();
      result.name = check.name;
      result.cases = check.prepare();
    }
    std::string why = why_not_one_run(earlier, now);
    if (why.empty() && earlier.facts.shard.index != shard.index) why = "another shard";
    if (!why.empty()) throw UsageError(fmt::format("--resume {}: it is of {}", options.resume, why));
  }

  catch_interrupts();
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return earlier.facts.seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (rival) {
    print(fmt::format("{} {}: {}\n", facts.rival, facts.rival_version,
                      subject.declared
                          ? "it declares " + facts.declared_model + "; probing finds " + facts.inferred_model
                          : "probing finds " + facts.inferred_model));
  }
  std::function<void(std::span<const CheckResult>)> save;
  if (!options.resume.empty()) {
    save = [&](std::span<const CheckResult> results) {
      Facts so_far = facts;
      so_far.seconds = seconds();
      so_far.interrupted = true;
      write_file(options.resume, certificate_json({so_far, {results.begin(), results.end()}}));
    };
  }
  Certificate certificate;
  certificate.results = run_checks(
      settings, checks, {options.jobs, options.output_directory, shard},
      [&settings](const CheckResult& result) { print(check_line(result, settings.seed)); }, earlier.results, save);
  facts.seconds = seconds();
  facts.interrupted = interrupted();
  if (rival) add_outcome(subject, certificate.results, facts);
  certificate.facts = facts;
  print(verdict_block(certificate.results, facts));
  write_reports(certificate, options.json, options.junit, options.html);
  return status_of(certificate);
}

void add_merge_options(CLI::App& app, MergeOptions& options) {
  app.add_option("JSON", options.shards, "The certificates of all shards of one run")->required();
  app.add_option("--json", options.json, "Write the certificate there, too, as JSON");
  app.add_option("--junit", options.junit, "The same as JUnit XML");
  app.add_option("--html", options.html, "The same as one page with pictures of the findings");
}

int run_merge(const MergeOptions& options) {
  check_outputs(reports(options.json, options.junit, options.html), options.shards);
  std::vector<Certificate> shards;
  for (const std::string& path : options.shards) shards.push_back(read_certificate_file(path));
  const Certificate whole = merge(shards, options.shards);
  for (const CheckResult& result : whole.results) print(check_line(result, whole.facts.seed));
  print(verdict_block(whole.results, whole.facts));
  write_reports(whole, options.json, options.junit, options.html);
  return status_of(whole);
}

}  // namespace surefill::certify
