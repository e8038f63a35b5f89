# What every target of the project is built with.

find_program(SUREFILL_CCACHE ccache)
if(SUREFILL_CCACHE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SUREFILL_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${SUREFILL_CCACHE})
endif()

# Warnings and sanitizers of the project's own code; libraries are included as SYSTEM.
add_library(surefill_flags INTERFACE)
target_compile_options(surefill_flags INTERFACE -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow)
# GCC bug 105651: g++ 12 warns of overlapping memory in std::string concatenations that are right.
target_compile_options(surefill_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>)
if(SUREFILL_WERROR)
  target_compile_options(surefill_flags INTERFACE -Werror)
endif()
# Contraction to FMA would silently break exact arithmetic (and make images differ between machines).
target_compile_options(surefill_flags INTERFACE -ffp-contract=off)
# For code whose own speed does not matter, tests and command lines: it compiles in half the time.
add_library(surefill_quick_build INTERFACE)
target_compile_options(surefill_quick_build INTERFACE $<$<CONFIG:Release>:-O1>)
# For whatever includes Highway: an instruction set that would add size and little speed between its neighbours.
set(SUREFILL_HIGHWAY HWY_DISABLED_TARGETS=HWY_SSSE3)

if(SUREFILL_SANITIZE)
  add_compile_options(-fsanitize=${SUREFILL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SUREFILL_SANITIZE})
endif()
if(SUREFILL_COVERAGE)
  add_compile_options(-fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
endif()
