# SPDX-License-Identifier: Apache-2.0
# Copies a shared library under its soname: -DLIBRARY=... -DTYPE=... -DPACKAGE=FOLDER. Static ones are linked in already.
if(NOT TYPE STREQUAL STATIC_LIBRARY AND LIBRARY MATCHES "\\.so")
  get_filename_component(file ${LIBRARY} REALPATH)
  execute_process(COMMAND objdump -p ${file} OUTPUT_VARIABLE headers COMMAND_ERROR_IS_FATAL ANY)
  if(NOT headers MATCHES "SONAME +([^\n ]+)")
    message(FATAL_ERROR "${file} has no soname")
  endif()
  configure_file(${file} ${PACKAGE}/${CMAKE_MATCH_1} COPYONLY)
endif()
