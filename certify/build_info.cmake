# Writes build_info.hpp at every build, and touches it only where something changed:
#   cmake -DSOURCE=... -DOUT=... -DCOMPILER=... -DFLAGS=... -P build_info.cmake
set(commit "unknown")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} rev-parse --show-toplevel WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  # Not the commit of some other repository that this source lies in.
  file(REAL_PATH "${SOURCE}" source)
  if(NOT failed AND top STREQUAL source)
    execute_process(COMMAND ${GIT} describe --always --dirty --abbrev=12 --exclude=* WORKING_DIRECTORY ${SOURCE}
      OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed)
      set(commit "${described}")
    endif()
  endif()
endif()
string(STRIP "${FLAGS}" FLAGS)
string(REGEX REPLACE " +" " " FLAGS "${FLAGS}")
set(text "// Written by the build.
#ifndef SUREFILL_CERTIFY_BUILD_INFO_HPP
#define SUREFILL_CERTIFY_BUILD_INFO_HPP
namespace surefill::certify {
inline constexpr const char* kBuildCommit = \"${commit}\";
inline constexpr const char* kBuildCompiler = \"${COMPILER}\";
inline constexpr const char* kBuildFlags = \"${FLAGS}\";
}  // namespace surefill::certify
#endif  // SUREFILL_CERTIFY_BUILD_INFO_HPP
")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
