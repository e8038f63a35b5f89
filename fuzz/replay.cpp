// SPDX-License-Identifier: Apache-2.0
//
// Runs files, and the files of directories, through a target, with any compiler and without a fuzzer:
//   NAME_replay [--mutations N] [--seed N] PATH...
// With --mutations each input is also run that many times after the target's own mutator. Exit 1 if there is nothing to
// run.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "properties/generators/generators.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                                             unsigned seed);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

surefill::properties::Random random_source(1);

// The input under way, which an abort names, and stores if it is a mutation: it stands in no file.
struct Current {
  std::string file;
  unsigned long mutation = 0;
  const std::vector<std::uint8_t>* bytes = nullptr;
} current;

extern "C" void on_abort(int) {
  if (current.mutation == 0) {
    std::fprintf(stderr, "replaying %s\n", current.file.c_str());
  } else {
    const char* const kFinding = "replay.finding";
    std::FILE* out = std::fopen(kFinding, "wb");
    if (out != nullptr) {
      std::fwrite(current.bytes->data(), 1, current.bytes->size(), out);
      std::fclose(out);
    }
    std::fprintf(stderr, "replaying mutation %lu of %s; stored as %s\n", current.mutation, current.file.c_str(),
                 kFinding);
  }
  std::signal(SIGABRT, SIG_DFL);
}

[[noreturn]] void fail(const std::string& cause) {
  std::fprintf(stderr, "replay: %s\n", cause.c_str());
  std::exit(1);
}

std::vector<std::string> files_below(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<std::string> files;
  for (fs::recursive_directory_iterator at(path, error), end; !error && at != end; at.increment(error)) {
    if (at->is_regular_file(error)) files.push_back(at->path().string());
  }
  if (error) fail(path + ": " + error.message());
  if (files.empty()) fail(path + ": an empty directory");
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) fail(path + ": cannot be read");
  return bytes;
}

unsigned long number(const char* text) {
  char* end = nullptr;
  const unsigned long value = std::strtoul(text, &end, 10);
  if (end == text || *end != '\0') fail(std::string(text) + " is not a number");
  return value;
}

// Runs a copy of exactly the input's size, so that the address sanitizer sees a read past its end.
void run(const std::vector<std::uint8_t>& bytes) {
  const std::vector<std::uint8_t> exact(bytes);
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

constexpr std::size_t kMaxSize = 4096;

std::vector<std::uint8_t> mutated(std::vector<std::uint8_t> bytes) {
  const std::size_t size = std::min(bytes.size(), kMaxSize);
  bytes.resize(kMaxSize);
  const auto seed = static_cast<unsigned>(random_source.bits());
  bytes.resize(LLVMFuzzerCustomMutator != nullptr ? LLVMFuzzerCustomMutator(bytes.data(), size, kMaxSize, seed)
                                                  : LLVMFuzzerMutate(bytes.data(), size, kMaxSize));
  return bytes;
}

}  // namespace

// What libFuzzer's own mutator is to a custom one, in its simplest form: one byte changed, added or taken away.
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  const auto byte = static_cast<std::uint8_t>(random_source.bits());
  const std::size_t at = size == 0 ? 0 : random_source.bits() % size;
  const std::uint32_t kind = random_source.below(8);
  if (size < max_size && (size == 0 || kind == 0)) {
    std::memmove(data + at + 1, data + at, size - at);
    data[at] = byte;
    return size + 1;
  }
  if (size > 1 && kind == 1) {
    std::memmove(data + at, data + at + 1, size - at - 1);
    return size - 1;
  }
  data[at] = kind == 2 ? byte : static_cast<std::uint8_t>(data[at] ^ (1u << (byte % 8)));
  return size;
}

int main(int argc, char** argv) {
  std::signal(SIGABRT, on_abort);
  unsigned long mutations = 0;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--mutations" || argument == "--seed") {
      if (i + 1 == argc) fail(std::string(argument) + " needs a number");
      const unsigned long value = number(argv[++i]);
      if (argument == "--mutations")
        mutations = value;
      else
        random_source = surefill::properties::Random(value);
      continue;
    }
    const std::vector<std::string> below = files_below(argv[i]);
    files.insert(files.end(), below.begin(), below.end());
  }
  if (files.empty()) fail("usage: NAME_replay [--mutations N] [--seed N] PATH...");
  for (const std::string& file : files) {
    std::vector<std::uint8_t> bytes = read_file(file);
    current = {file, 0, &bytes};
    run(bytes);
    for (unsigned long n = 1; n <= mutations; ++n) {
      std::vector<std::uint8_t> next = mutated(n % 8 == 1 ? read_file(file) : std::move(bytes));
      bytes = std::move(next);
      current.mutation = n;
      run(bytes);
    }
  }
  std::printf("%zu files, %lu inputs each: every relation holds\n", files.size(), mutations + 1);
  return 0;
}
