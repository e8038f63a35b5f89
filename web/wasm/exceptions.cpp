// SPDX-License-Identifier: Apache-2.0
//
// C++ exceptions for WebAssembly: what the compiler calls where the code throws and catches (the Itanium C++ ABI, exception
// handling, with one tag of WebAssembly for all of C++). Debian's library of the ABI is built without. One thread; no exception
// specifications; exceptions of other languages do not come here.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <typeinfo>

namespace {

// Lies before each exception object.
struct alignas(16) Header {
  const std::type_info* type;
  void* (*destroy)(void*);  // a destructor returns `this` in WebAssembly
  int handlers;             // that have begun and not ended
  bool thrown_again;        // by the last of them
  Header* below;            // the exception that was being handled before
  void* adjusted;           // the object as the handler's type
};

Header* caught = nullptr;  // the one being handled

Header* header_of(void* object) {
  return static_cast<Header*>(object) - 1;
}

// What the library knows of types, by its place in the table of virtual functions: libc++abi's __shim_type_info.
class Type : public std::type_info {
 public:
  ~Type() override;
  virtual void unused_1() const;
  virtual void unused_2() const;
  virtual bool can_catch(const Type* thrown, void*& adjusted) const = 0;
};

// A number of the tables, LEB128.
std::int32_t number(const std::uint8_t*& at, bool is_signed = false) {
  std::uint32_t value = 0, shift = 0;
  std::uint8_t byte = 0;
  do {
    byte = *at++;
    value |= static_cast<std::uint32_t>(byte & 0x7F) << shift;
    shift += 7;
  } while (byte & 0x80);
  if (is_signed && (byte & 0x40) && shift < 32) value |= ~std::uint32_t{0} << shift;
  return static_cast<std::int32_t>(value);
}

constexpr int kTag = 0;  // __cpp_exception
constexpr std::uint8_t kOmitted = 0xFF;

}  // namespace

extern "C" {

// What a landing pad says before it asks, and is answered: which of its types catches; 0: none.
struct LandingPad {
  std::uintptr_t index;
  const std::uint8_t* table;
  std::uintptr_t selector;
};
thread_local LandingPad __wasm_lpad_context;

void* __cxa_allocate_exception(std::size_t size) noexcept {
  void* memory = std::calloc(1, sizeof(Header) + size);
  if (memory == nullptr) std::terminate();
  return static_cast<Header*>(memory) + 1;
}

void __cxa_free_exception(void* object) noexcept {
  std::free(header_of(object));
}

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void* (*destroy)(void*)) {
  Header* header = header_of(object);
  header->type = type;
  header->destroy = destroy;
  __builtin_wasm_throw(kTag, object);
}

int _Unwind_CallPersonality(void* object) {
  LandingPad& pad = __wasm_lpad_context;
  Header* header = header_of(object);
  pad.selector = 0;
  const std::uint8_t* at = pad.table;
  if (at == nullptr) return 0;
  if (*at++ != kOmitted) std::abort();
  const std::uint8_t* types = nullptr;
  if (*at++ != kOmitted) {
    const std::int32_t offset = number(at);
    types = at + offset;
  }
  ++at;  // how the numbers of this table are written
  const std::int32_t length = number(at);
  const std::uint8_t* actions = at + length;
  while (at < actions) {
    const auto index = static_cast<std::uintptr_t>(number(at));
    const std::int32_t first = number(at);
    if (index != pad.index) continue;
    if (first == 0) return 0;
    for (const std::uint8_t* action = actions + first - 1;;) {
      const std::int32_t filter = number(action, true);
      const std::uint8_t* next = action;
      const std::int32_t step = number(next, true);
      if (filter > 0) {
        const Type* type = nullptr;  // null: catch (...)
        std::memcpy(&type, types - 4 * filter, sizeof type);
        void* adjusted = object;
        if (type == nullptr || type->can_catch(static_cast<const Type*>(header->type), adjusted)) {
          header->adjusted = adjusted;
          pad.selector = static_cast<std::uintptr_t>(filter);
          return 0;
        }
      }
      if (step == 0) return 0;
      action += step;
    }
  }
  return 0;
}

void* __cxa_get_exception_ptr(void* object) noexcept {
  return header_of(object)->adjusted;
}

void* __cxa_begin_catch(void* object) noexcept {
  Header* header = header_of(object);
  header->thrown_again = false;
  ++header->handlers;
  if (caught != header) {
    header->below = caught;
    caught = header;
  }
  return header->adjusted == nullptr ? object : header->adjusted;
}

void __cxa_end_catch() {
  Header* header = caught;
  if (header == nullptr || --header->handlers > 0) return;
  caught = header->below;
  if (header->thrown_again) return;
  void* object = header + 1;
  if (header->destroy != nullptr) (void)header->destroy(object);
  __cxa_free_exception(object);
}

[[noreturn]] void __cxa_rethrow() {
  Header* header = caught;
  if (header == nullptr) std::terminate();
  header->thrown_again = true;
  __builtin_wasm_throw(kTag, header + 1);
}

// Named in the tables; landing pads ask _Unwind_CallPersonality instead.
int __gxx_wasm_personality_v0() {
  return 0;
}

}  // extern "C"
