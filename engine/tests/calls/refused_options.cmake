# SPDX-License-Identifier: Apache-2.0
# The preprocessor refuses the engine's sources under options that break exact arithmetic, with a sentence that says what to
# do; and takes them without. COMPILER, COMPILER_ID, PROCESSOR, ENGINE, SOURCES.
function(preprocess source result)
  execute_process(COMMAND ${COMPILER} -std=c++20 ${ARGN} -I${ENGINE}/include -I${ENGINE}/src -E ${source}
    OUTPUT_QUIET ERROR_VARIABLE error RESULT_VARIABLE code)
  if(code EQUAL 0)
    set(${result} accepted PARENT_SCOPE)
  else()
    set(${result} "${error}" PARENT_SCOPE)
  endif()
endfunction()

function(refuse source option sentence)
  preprocess(${source} result ${option})
  if(NOT result MATCHES "${sentence}")
    message(SEND_ERROR "${option}, ${source}: ${result}")
  endif()
endfunction()

set(fast "compile its sources without -ffast-math")
foreach(source IN LISTS SOURCES)
  refuse(${source} -ffast-math "${fast}")
endforeach()

list(FILTER SOURCES INCLUDE REGEX "reference\\.cpp$")
preprocess(${SOURCES} result -O2)
if(NOT result STREQUAL accepted)
  message(SEND_ERROR "without such options: ${result}")
endif()
set(options -Ofast -ffinite-math-only)
if(COMPILER_ID STREQUAL GNU)
  list(APPEND options -funsafe-math-optimizations -freciprocal-math -fno-signed-zeros)
endif()
foreach(option IN LISTS options)
  refuse(${SOURCES} ${option} "${fast}")
endforeach()
if(COMPILER_ID STREQUAL GNU AND PROCESSOR MATCHES "x86_64|AMD64")
  refuse(${SOURCES} -mfpmath=387 "-msse2 -mfpmath=sse")
  preprocess(${SOURCES} result -mavx512fp16)  # FLT_EVAL_METHOD speaks of _Float16 then
  if(NOT result STREQUAL accepted)
    message(SEND_ERROR "-mavx512fp16: ${result}")
  endif()
endif()
