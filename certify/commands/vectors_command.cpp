// SPDX-License-Identifier: Apache-2.0
#include "certify/commands/vectors_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

#include "certify/commands/certify_command.hpp"
#include "certify/commands/options.hpp"
#include "certify/run/files.hpp"
#include "certify/vectors/vectors.hpp"

namespace surefill::certify {
namespace {

constexpr std::size_t kSmokeBytes = 150000;
constexpr std::size_t kMostBytes = 8000000;

// The files lie beside the corpus.
std::string folder_of(const std::string& given, const std::function<std::string()>& corpus) {
  if (!given.empty()) return given;
  return (std::filesystem::path(corpus()).parent_path() / "vectors").string();
}

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string text_of(const vectors::File& file, bool with_expectations) {
  std::string text;
  for (const vectors::Test& test : file.tests) text += vectors::text_of(test, with_expectations) + "\n";
  return text;
}

// Puts a table between <!-- NAME --> and <!-- end -->.
void put_table(std::string& page, const std::string& path, const std::string& name, const std::string& table) {
  const std::string mark = "<!-- " + name + " -->\n";
  const std::size_t begin = page.find(mark), end = page.find("<!-- end -->", begin);
  if (begin == std::string::npos || end == std::string::npos)
    throw std::runtime_error(path + ": no place for the table " + name);
  page.replace(begin + mark.size(), end - begin - mark.size(), table);
}

int write_tables(const std::string& path, const std::string& folder) {
  std::string page = read_all(path);
  const vectors::Tables tables = vectors::tables_of(folder);
  put_table(page, path, "files", tables.files);
  put_table(page, path, "matrix", tables.matrix);
  put_table(page, path, "not shown", tables.not_shown);
  write_file(path, page);
  return kGood;
}

// Chooses all subjects' tests, on several threads.
std::vector<vectors::File> choose_all(const std::vector<std::string>& wanted, const std::string& corpus, int jobs,
                                      vectors::Faults& faults) {
  const auto subjects = vectors::subjects();
  std::vector<vectors::File> files(subjects.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  std::vector<std::thread> threads;
  for (int i = 0; i < jobs; ++i) {
    threads.emplace_back([&] {
      for (std::size_t n = next++; n < subjects.size(); n = next++) {
        if (std::find(wanted.begin(), wanted.end(), "all") == wanted.end() &&
            std::find(wanted.begin(), wanted.end(), subjects[n].name) == wanted.end())
          continue;
        try {
          vectors::Faults own;
          files[n] = vectors::choose(subjects[n], static_cast<int>(n) + 1, corpus, own);
          const std::lock_guard lock(mutex);
          for (const auto& [name, effects] : own) faults[name].take(effects);
          fmt::print(stderr, "{}: {} tests\n", subjects[n].name, files[n].tests.size());
        } catch (...) {
          const std::lock_guard lock(mutex);
          failure = std::current_exception();
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  std::erase_if(files, [](const vectors::File& file) { return file.tests.empty(); });
  return files;
}

int make(const VectorsOptions& options, const std::string& folder, const std::string& corpus) {
  check_folder(folder);
  std::filesystem::create_directories(folder + "/schemas");
  vectors::Faults faults;
  std::vector<vectors::File> files = choose_all(options.make, corpus, options.jobs, faults);
  const bool all = files.size() == vectors::subjects().size();
  if (all) files.push_back(vectors::smoke_of(files, kSmokeBytes));
  std::size_t bytes = 0, tests = 0;
  for (const vectors::File& file : files) {
    const std::string json = vectors::json_of(file, faults), text = text_of(file, true);
    const std::string faults_text = vectors::faults_of(file);
    bytes += json.size() + text.size() + faults_text.size(), tests += file.tests.size();
    write_file(folder + "/" + file.subject.name + ".json", json);
    write_file(folder + "/" + file.subject.name + ".txt", text);
    write_file(folder + "/" + file.subject.name + ".faults.txt", faults_text);
    write_file(folder + "/schemas/" + file.subject.name + ".json", vectors::schema_of(file));
  }
  std::string alive;
  for (const zoo::Specimen& specimen : zoo::specimens()) {
    const bool shown = std::any_of(files.begin(), files.end(), [&](const vectors::File& file) {
      return std::any_of(file.tests.begin(), file.tests.end(),
                         [&](const vectors::Test& test) { return test.kills.contains(specimen.name); });
    });
    if (shown == !vectors::why_not_shown(specimen.name).empty()) alive += fmt::format(" {}", specimen.name);
  }
  fmt::print("{} files, {} tests, {} bytes\n", files.size(), tests, bytes);
  if (all && !alive.empty()) return fmt::print("not shown, or shown against what the table says:{}\n", alive), kBad;
  return bytes > kMostBytes ? (fmt::print("more than {} bytes\n", kMostBytes), kBad) : kGood;
}

// The lines of a subject's twin, without what is expected: a line's second word says how many words come before that.
int print_text(const std::string& folder, const std::string& subject) {
  const std::string path = folder + "/" + subject + ".txt";
  std::istringstream lines(read_all(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::size_t id = 0, kept = 0, end = 0;
    if (!(words >> id >> kept)) throw std::runtime_error(path + ": no text twin of vectors");
    for (std::size_t n = 0; n < kept && end < line.size(); ++n)
      end = std::min(line.find(' ', end), line.size() - 1) + 1;
    if (end > 0 && line[end - 1] == ' ') --end;
    fmt::print("{}\n", line.substr(0, end));
  }
  return kGood;
}

}  // namespace

CLI::App* add_vectors_command(CLI::App& app, VectorsOptions& options) {
  CLI::App* command = app.add_subcommand("vectors", "Print test vectors as text, or make the files anew");
  command->add_option("--text", options.text, "The subject to print, a test a line, without what is expected");
  add_names(*command, "--make", options.make, "Subjects to make anew, or all: minutes");
  command->add_option("--folder", options.folder, "Where the files are (vectors/ beside the corpus)");
  command->add_option("--markdown", options.markdown, "Write the tables of this page anew (docs/vectors.md)");
  add_whole_number(*command, "--jobs", options.jobs, 1, 256, "Threads (1)");
  return command;
}

int run_vectors(VectorsOptions options, const std::function<std::string()>& corpus) {
  const std::string folder = folder_of(options.folder, corpus);
  const int given = static_cast<int>(!options.text.empty()) + static_cast<int>(!options.make.empty()) +
                    static_cast<int>(!options.markdown.empty());
  if (given != 1) throw UsageError("vectors: one of --text SUBJECT, --make SUBJECTS and --markdown PAGE is needed");
  if (!options.make.empty()) return make(options, folder, corpus());
  if (!options.markdown.empty()) return write_tables(options.markdown, folder);
  return print_text(folder, options.text);
}

CLI::App* add_verify_command(CLI::App& app, VerifyOptions& options) {
  CLI::App* command =
      app.add_subcommand("verify", "Hold results against test vectors: a line a test, its number and what came");
  command->add_option("RESULTS", options.results, "A file of such lines, or .json (standard input with --text)");
  command->add_flag("--text", options.text, "Read them from standard input");
  command->add_option("--folder", options.folder, "Where the vectors are (vectors/ beside the corpus)");
  return command;
}

int run_verify(VerifyOptions options, const std::function<std::string()>& corpus) {
  if (options.text == !options.results.empty()) throw UsageError("verify: a file of results, or --text, is needed");
  const std::string folder = folder_of(options.folder, corpus);
  std::vector<vectors::Owed> owed;
  std::set<int> smoke;
  for (const std::string& subject : vectors::subjects_in(folder)) {
    std::vector<vectors::Owed> more = vectors::read_owed(folder, subject);
    if (subject == "smoke") {  // its tests are those of the others
      for (const vectors::Owed& test : more) smoke.insert(test.id);
    } else {
      std::move(more.begin(), more.end(), std::back_inserter(owed));
    }
  }
  std::string lines;
  if (options.text) {
    lines.assign(std::istreambuf_iterator<char>(std::cin), {});
  } else {
    lines = read_all(options.results);
    if (has_ending(options.results, ".json")) lines = vectors::lines_of_json(lines, options.results, owed);
  }
  const vectors::Verdict verdict = vectors::verify(owed, lines, smoke);
  std::fputs(verdict.text.c_str(), stdout);
  return verdict.passed ? kGood : kBad;
}

}  // namespace surefill::certify
