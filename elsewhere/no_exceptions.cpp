// SPDX-License-Identifier: Apache-2.0
//
// For machines without exceptions (WebAssembly as clang 19 and its C++ library have it): what would be thrown ends the
// program. The corpus reader throws only where a scene is wrong.
#include <cstddef>
#include <cstdio>
#include <cstdlib>

extern "C" [[noreturn]] void* __cxa_allocate_exception(std::size_t) {
  std::fputs("an exception\n", stderr);
  std::exit(3);
}

extern "C" [[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) {
  std::exit(3);
}
