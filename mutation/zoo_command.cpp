// SPDX-License-Identifier: Apache-2.0
//
// surefill-zoo: holds the wrong rasterizers of the zoo against every property, or certifies each as a rival.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>

#include "certify/commands/certify_command.hpp"
#include "certify/commands/options.hpp"
#include "certify/rivals/host.hpp"
#include "certify/run/files.hpp"
#include "certify/run/progress.hpp"
#include "mutation/called.hpp"
#include "mutation/matrix.hpp"
#include "mutation/matrix_rivals.hpp"

namespace surefill::mutation {
namespace {

struct Arguments {
  ZooOptions options;
  std::string markdown, picture, level = "quick";
  ZooRivalOptions rivals;
  bool names = false;
};

int run(Arguments& arguments) {
  const certify::OutputFile outputs[] = {{"--markdown", arguments.markdown, {".md"}},
                                         {"--picture", arguments.picture, {".svg"}}};
  certify::check_outputs(outputs, {&arguments.rivals.plugin, 1});
  certify::catch_interrupts();
  if (!arguments.rivals.plugin.empty()) {
    arguments.rivals.settings.level = certify::level_named(arguments.level);
    arguments.rivals.settings.corpus = SUREFILL_CORPUS;
    arguments.rivals.jobs = arguments.options.jobs;
    const bool told = zoo_rivals(arguments.rivals, certify::print);
    return certify::interrupted() ? certify::kInterrupted : told ? certify::kGood : certify::kBad;
  }
  if (arguments.names) {
    const bool told = zoo_names(certify::print);
    return certify::interrupted() ? certify::kInterrupted : told ? certify::kGood : certify::kBad;
  }
  const KillMatrix matrix = kill_matrix(arguments.options);
  certify::print(zoo_text(matrix));
  if (matrix.interrupted) return certify::kInterrupted;
  if (!arguments.markdown.empty()) {
    certify::write_file(arguments.markdown,
                        zoo_markdown(matrix, std::filesystem::path(arguments.picture).filename().string()));
  }
  if (!arguments.picture.empty()) certify::write_file(arguments.picture, zoo_picture(matrix));
  return matrix.failures().empty() ? certify::kGood : certify::kBad;
}

int parse_and_run(int argc, char** argv) {
  // The process that is started for a plugin is this program again, as it is of surefill.
  if (argc > 2 && std::string_view(argv[1]) == "plugin-host") {
    return adapters::host_plugin(argv[2], argc > 3 ? argv[3] : "");
  }
  Arguments arguments;
  arguments.options.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  arguments.options.cases = 500;
  CLI::App app("Holds wrong rasterizers against every property: all must be killed.", "surefill-zoo");
  certify::add_whole_number(app, "--cases", arguments.options.cases, 1, 100000000, "Of each property (500)");
  app.add_option("--markdown", arguments.markdown, "Write the table there")
      ->needs(app.add_option("--picture", arguments.picture, "Draw the matrix there, as SVG"));
  certify::add_whole_number(app, "--jobs", arguments.options.jobs, 1, 4096, "Threads (all cores)");
  CLI::Option* plugin = app.add_option("--plugin", arguments.rivals.plugin,
                                       "libsurefill_zoo.so: certify each as a rival behind the adapter instead");
  certify::add_names(app, "--only", arguments.rivals.only, "Names with * and ?, separated by commas")->needs(plugin);
  app.add_flag("--undeclared", arguments.rivals.undeclared, "With --plugin: none says what its model is")
      ->needs(plugin);
  app.add_flag("--names", arguments.names, "Say what each specimen's fault is called, and thirty further ones");
  app.add_option("--level", arguments.level, "Of certify: quick, standard or thorough (quick)")
      ->check(CLI::IsMember({"quick", "standard", "thorough"}))
      ->needs(plugin);
  try {
    certify::refuse_empty_values(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw certify::UsageError(std::string(error.what()) + " (--help shows the usage)");
  }
  return run(arguments);
}

}  // namespace
}  // namespace surefill::mutation

int main(int argc, char** argv) {
  try {
    return surefill::mutation::parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surefill-zoo: %s\n", error.what());
  }
  return surefill::certify::kUsage;
}
