// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/host.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "certify/rivals/stated_model.hpp"
#include "certify/rivals/wire.hpp"

namespace surefill::adapters {

namespace {

constexpr int kHostFailed = 70;  // exit status where the host itself cannot go on
constexpr unsigned char kUnwritten = 0xA5;
constexpr std::size_t kMargin = 64;  // bytes before a buffer that are looked at after each draw

std::size_t page_size() {
  static const auto size = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return size;
}

// Pages of which the last cannot be touched; the data end where it begins.
class GuardedPages {
 public:
  GuardedPages(std::string name, std::size_t bytes)
      : name_(std::move(name)),
        bytes_(bytes),
        usable_((bytes + kMargin + page_size() - 1) / page_size() * page_size()) {
    void* pages = ::mmap(nullptr, usable_ + page_size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) {
      std::perror("surefill: plugin host: mmap");
      std::_Exit(kHostFailed);
    }
    pages_ = static_cast<unsigned char*>(pages);
    ::mprotect(pages_ + usable_, page_size(), PROT_NONE);
    std::memset(pages_, kUnwritten, usable_);
  }
  ~GuardedPages() { ::munmap(pages_, usable_ + page_size()); }
  GuardedPages(const GuardedPages&) = delete;
  GuardedPages& operator=(const GuardedPages&) = delete;

  void* data() const { return pages_ + usable_ - bytes_; }
  const std::string& name() const { return name_; }
  void make_read_only() { ::mprotect(pages_, usable_, PROT_READ); }
  bool holds(const void* address) const {
    const auto at = reinterpret_cast<std::uintptr_t>(address), begin = reinterpret_cast<std::uintptr_t>(pages_);
    return at >= begin && at < begin + usable_ + page_size();
  }
  bool margin_untouched() const {
    const unsigned char* end = pages_ + usable_ - bytes_;
    return std::all_of(end - kMargin, end, [](unsigned char byte) { return byte == kUnwritten; });
  }

 private:
  std::string name_;
  std::size_t bytes_, usable_;
  unsigned char* pages_ = nullptr;
};

using Buffers = std::vector<std::unique_ptr<GuardedPages>>;

// For the signal handler: what is mapped during a draw.
const Buffers* current_outputs = nullptr;
const GuardedPages* current_scene = nullptr;

void say(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(2, text, std::strlen(text));
}

void on_bad_access(int signal, siginfo_t* info, void*) {
  if (current_scene && current_scene->holds(info->si_addr)) say("it wrote to the scene, or read past its end");
  if (current_outputs) {
    for (const auto& buffer : *current_outputs) {
      if (!buffer->holds(info->si_addr)) continue;
      say("it went past the end of the buffer \"");
      say(buffer->name().c_str());
      say("\"");
    }
  }
  say("\n");
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void watch_accesses() {
  static std::vector<char> stack(1 << 16);  // also where the plugin has used up its own
  stack_t alternative{};
  alternative.ss_sp = stack.data();
  alternative.ss_size = stack.size();
  ::sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_bad_access;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGSEGV, &action, nullptr);
  ::sigaction(SIGBUS, &action, nullptr);
}

bool read_all(int from, void* place, std::size_t bytes) {
  auto* at = static_cast<char*>(place);
  while (bytes > 0) {
    const ssize_t n = ::read(from, at, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

void write_all(int to, const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t n = ::write(to, at, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) std::_Exit(kHostFailed);
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
}

void reply(int to, std::uint32_t status, const Words& words) {
  const std::uint32_t header[kHeaderWords] = {status, static_cast<std::uint32_t>(words.size())};
  write_all(to, header, sizeof header);
  write_all(to, words.data(), words.size() * 4);
}

void reply_text(int to, int status, const char* text) {
  reply(to, static_cast<std::uint32_t>(status == SUREFILL_ADAPTER_UNSUPPORTED ? status : SUREFILL_ADAPTER_FAILED),
        text_words(text ? std::string(text).substr(0, 1000) : "no error text"));
}

// What a plugin exports: one of the two.
struct Plugin {
  const surefill_adapter_api* first = nullptr;
  const surefill_adapter2_api* second = nullptr;
};

// A struct of version 2 that a plugin fills, with room for one that knows more than we do.
template <typename Struct>
class Room {
 public:
  explicit Room(const Struct& defaults) {
    std::memcpy(words_.data(), &defaults, sizeof defaults);
    words_[0] = kRoomWords * 4;
  }
  Struct* place() { return reinterpret_cast<Struct*>(words_.data()); }
  // What was filled in, as far as it goes.
  Words words() const {
    const std::size_t size = std::clamp<std::size_t>(words_[0] / 4, 1, kRoomWords);
    return {words_.begin(), words_.begin() + static_cast<std::ptrdiff_t>(size)};
  }

 private:
  static constexpr std::size_t kRoomWords = 1024;
  alignas(8) std::array<std::uint32_t, kRoomWords> words_{};
};

class Host {
 public:
  Host(const Plugin& plugin, std::string arguments, int output)
      : plugin_(plugin), arguments_(std::move(arguments)), output_(output) {}

  ~Host() {
    if (instance_) plugin_.second ? plugin_.second->close(instance_) : plugin_.first->close(instance_);
  }

  std::uint32_t version() const { return plugin_.second ? SUREFILL_ADAPTER2_VERSION : SUREFILL_ADAPTER_VERSION; }

  // `asked`: the version that certify asks for. One of version 2 that is asked for 1 answers with its version alone.
  void open(std::uint32_t asked) {
    if (plugin_.second && asked != SUREFILL_ADAPTER2_VERSION) {
      reply(output_, SUREFILL_ADAPTER_OK, {SUREFILL_ADAPTER2_VERSION});
      return;
    }
    surefill_adapter_info info{};
    Room<surefill_adapter2_info> info2{{}};
    const int status = plugin_.second ? plugin_.second->open(arguments_.c_str(), info2.place(), &instance_)
                                      : plugin_.first->open(arguments_.c_str(), &info, &instance_);
    if (status != SUREFILL_ADAPTER_OK) {
      reply_text(output_, status, error_text(nullptr));
      return;
    }
    reply(output_, SUREFILL_ADAPTER_OK, plugin_.second ? info2.words() : struct_words(info));
  }

  // Version 2 alone.
  void model() {
    const surefill_adapter2_api& api = *plugin_.second;
    Room<surefill_adapter2_model> model(default_model());
    const bool stated = SUREFILL_ADAPTER2_HAS(surefill_adapter2_api, &api, model) && api.model;
    const int status = stated ? api.model(instance_, model.place()) : SUREFILL_ADAPTER_UNSUPPORTED;
    if (status != SUREFILL_ADAPTER_OK) {
      reply_text(output_, status, stated ? error_text(instance_) : "no model is stated");
      return;
    }
    reply(output_, SUREFILL_ADAPTER_OK, model.words());
  }

  void draw(GuardedPages& body, std::size_t words) {
    DecodedScene decoded;
    if (!decode_scene({static_cast<const std::uint32_t*>(body.data()), words}, decoded, version())) {
      reply_text(output_, SUREFILL_ADAPTER_FAILED, "the host got a message that is no scene");
      return;
    }
    surefill_adapter_image image{};
    // Addresses that say "asked for", until the buffers are there.
    std::uint32_t word = 0;
    float number = 0;
    std::vector<float*> attributes(decoded.components.size(), &number);
    if (decoded.outputs & SUREFILL_ADAPTER_COUNT) image.count = &word;
    if (decoded.outputs & SUREFILL_ADAPTER_INDEX) image.index = &word;
    if (decoded.outputs & SUREFILL_ADAPTER_DEPTH) image.depth = &number;
    if (decoded.outputs & SUREFILL_ADAPTER_BARYCENTRICS) image.barycentrics = &number;
    if (decoded.outputs & SUREFILL_ADAPTER_ATTRIBUTES) image.attributes = attributes.data();
    const std::vector<OutputBuffer> outputs = output_buffers(decoded.scene, image);
    Buffers buffers;
    for (const OutputBuffer& output : outputs) {
      buffers.push_back(std::make_unique<GuardedPages>(output.name, output.size * 4));
    }
    std::size_t next = 0;
    const auto words_of = [&] { return static_cast<std::uint32_t*>(buffers[next++]->data()); };
    const auto floats_of = [&] { return static_cast<float*>(buffers[next++]->data()); };
    if (image.count) image.count = words_of();
    if (image.index) image.index = words_of();
    if (image.depth) image.depth = floats_of();
    if (image.barycentrics) image.barycentrics = floats_of();
    if (image.attributes && decoded.scene.draw_count > 0) {
      for (float*& attribute : attributes) attribute = floats_of();
    }
    body.make_read_only();
    const SceneOfVersion2 second(decoded.scene, decoded.primitives);
    const surefill_adapter2_image image2 = image_of_version_2(image);
    current_scene = &body;
    current_outputs = &buffers;
    const int status = plugin_.second ? plugin_.second->draw(instance_, &second.scene(), &image2)
                                      : plugin_.first->draw(instance_, &decoded.scene, &image);
    current_outputs = nullptr;
    current_scene = nullptr;
    for (const auto& buffer : buffers) {
      if (buffer->margin_untouched()) continue;
      std::fprintf(stderr, "it wrote before the beginning of the buffer \"%s\"\n", buffer->name().c_str());
      std::fflush(stderr);
      std::_Exit(kHostFailed);
    }
    if (status != SUREFILL_ADAPTER_OK) {
      reply_text(output_, status, error_text(instance_));
      return;
    }
    Words answer;
    for (std::size_t n = 0; n < outputs.size(); ++n) {
      const auto* data = static_cast<const std::uint32_t*>(buffers[n]->data());
      answer.insert(answer.end(), data, data + outputs[n].size);
    }
    reply(output_, SUREFILL_ADAPTER_OK, answer);
  }

  bool is_open() const { return instance_ != nullptr; }

 private:
  const char* error_text(void* instance) const {
    return plugin_.second ? plugin_.second->error_text(instance) : plugin_.first->error_text(instance);
  }

  Plugin plugin_;
  std::string arguments_;
  int output_;
  void* instance_ = nullptr;
};

// What the library exports; else what is wrong with it.
std::string find_plugin(const std::string& library, Plugin& plugin) {
  void* handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return ::dlerror();
  using Entry2 = const surefill_adapter2_api* (*)();
  if (const auto entry = reinterpret_cast<Entry2>(::dlsym(handle, "surefill_adapter2_entry"))) {
    const surefill_adapter2_api* api = entry();
    if (!api) return library + ": its adapter of version 2 is null";
    if (!SUREFILL_ADAPTER2_HAS(surefill_adapter2_api, api, error_text) || api->version != SUREFILL_ADAPTER2_VERSION) {
      return library + ": its adapter has another version than 2";
    }
    if (!api->open || !api->draw || !api->close || !api->error_text)
      return library + ": its adapter has a null function";
    plugin.second = api;
    return "";
  }
  using Entry = const surefill_adapter_api* (*)(std::uint32_t);
  const auto entry = reinterpret_cast<Entry>(::dlsym(handle, "surefill_adapter_entry"));
  if (!entry) return library + ": exports no surefill_adapter_entry";
  const surefill_adapter_api* api = entry(SUREFILL_ADAPTER_VERSION);
  if (!api) return library + ": knows no adapter of version 1";
  if (api->version != SUREFILL_ADAPTER_VERSION) return library + ": its adapter has another version than 1";
  if (!api->open || !api->draw || !api->close || !api->error_text) return library + ": its adapter has a null function";
  plugin.first = api;
  return "";
}

}  // namespace

int host_plugin(const std::string& library, const std::string& arguments) {
  // Messages keep their own descriptor; what the plugin prints goes to stderr.
  const int output = ::dup(1);
  ::dup2(2, 1);
  watch_accesses();
  Plugin plugin;
  const std::string problem = find_plugin(library, plugin);
  std::unique_ptr<Host> host;
  if (problem.empty()) host = std::make_unique<Host>(plugin, arguments, output);
  std::uint32_t header[kHeaderWords];
  while (read_all(0, header, sizeof header)) {
    GuardedPages body("scene", std::size_t{header[1]} * 4);
    if (!read_all(0, body.data(), std::size_t{header[1]} * 4)) return kHostFailed;
    if (header[0] == kClose) return 0;
    if (!host) {
      reply_text(output, SUREFILL_ADAPTER_FAILED, problem.c_str());
    } else if (header[0] == kOpen && !host->is_open()) {
      host->open(header[1] > 0 ? *static_cast<const std::uint32_t*>(body.data()) : 0);
    } else if (header[0] == kModel && host->version() == SUREFILL_ADAPTER2_VERSION) {
      host->model();
    } else if (header[0] == kDraw) {
      host->draw(body, header[1]);
    } else {
      reply_text(output, SUREFILL_ADAPTER_FAILED, "the host got a message of an unknown kind");
    }
  }
  return 0;
}

}  // namespace surefill::adapters
