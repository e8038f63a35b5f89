// SPDX-License-Identifier: Apache-2.0
//
// What compiler and libraries expect of a system, in one thread: objects of a thread live as long as the program, and Debian's
// compiler-rt guards its stack.
#include <boost/assert/source_location.hpp>
#include <cstdint>
#include <cstdlib>
#include <exception>

extern "C" {

int __cxa_atexit(void (*destroy)(void*), void* object, void* library);

int __cxa_thread_atexit(void (*destroy)(void*), void* object, void* library) {
  return __cxa_atexit(destroy, object, library);
}

std::uintptr_t __stack_chk_guard = 0x5AFE57AC;

[[noreturn]] void __stack_chk_fail() {
  std::abort();
}

}  // extern "C"

// Where Boost's numbers are compiled without exceptions: nobody divides by 0 there.
namespace boost {

[[noreturn]] void throw_exception(const std::exception&) {
  std::abort();
}

[[noreturn]] void throw_exception(const std::exception&, const source_location&) {
  std::abort();
}

}  // namespace boost
