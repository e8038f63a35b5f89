# SPDX-License-Identifier: Apache-2.0
# cmake -DCOMMAND=... -DEXPECTED=FILE -P expect.cmake: runs a command; its output must be the file's text.
execute_process(COMMAND ${COMMAND} OUTPUT_VARIABLE output RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "exit status ${status}:\n${output}")
endif()
file(READ ${EXPECTED} expected)
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "the output is not that of ${EXPECTED}:\n${output}")
endif()
