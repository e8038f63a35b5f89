# What every target of the project is built with.

find_program(SUREFILL_CCACHE ccache)
if(SUREFILL_CCACHE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SUREFILL_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${SUREFILL_CCACHE})
endif()

# Warnings and sanitizers of the project's own code; libraries are included as SYSTEM.
add_library(surefill_flags INTERFACE)
set(surefill_gnu_like $<CXX_COMPILER_ID:GNU,Clang,AppleClang>)  # these compilers have the options below
target_compile_options(surefill_flags INTERFACE
  "$<${surefill_gnu_like}:-Wall;-Wextra;-Wconversion;-Wsign-conversion;-Wshadow>")
# GCC bug 105651: g++ 12 warns of overlapping memory in std::string concatenations that are right.
target_compile_options(surefill_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>)
# clang 19 reports, of our use of std::stable_sort, a deprecated function inside libstdc++ 12.
target_compile_options(surefill_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-deprecated-declarations>)
if(SUREFILL_WERROR)
  target_compile_options(surefill_flags INTERFACE -Werror)
endif()
# Contraction to FMA would silently break exact arithmetic (and make images differ between machines).
target_compile_options(surefill_flags INTERFACE $<${surefill_gnu_like}:-ffp-contract=off>)
# For code whose own speed does not matter, tests and command lines: it compiles in half the time.
add_library(surefill_quick_build INTERFACE)
target_compile_options(surefill_quick_build INTERFACE $<$<AND:$<CONFIG:Release>,${surefill_gnu_like}>:-O1>)
# For whatever includes Highway. Left out are: instruction sets that would add size and little speed to their neighbours; vectors
# of a size that only the machine knows, of which no structure can be made; NEON of 32 bits, which has no doubles. On ARM nothing is
# chosen at run time (the second definition says so to Highway): what there is to choose, NEON, is there.
set(SUREFILL_HIGHWAY_LEFT_OUT "HWY_SSSE3|HWY_AVX3_DL|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV")
if(CMAKE_SIZEOF_VOID_P EQUAL 4)
  string(APPEND SUREFILL_HIGHWAY_LEFT_OUT "|HWY_NEON")
endif()
set(SUREFILL_HIGHWAY "HWY_DISABLED_TARGETS=(${SUREFILL_HIGHWAY_LEFT_OUT})" TOOLCHAIN_MISS_SYS_AUXV_H)

if(SUREFILL_SANITIZE)
  add_compile_options(-fsanitize=${SUREFILL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SUREFILL_SANITIZE})
endif()
if(SUREFILL_COVERAGE)
  add_compile_options(-fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
endif()
