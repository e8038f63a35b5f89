# SPDX-License-Identifier: Apache-2.0
# The Debian package, by CPack: `cmake --preset package && cmake --build build/package --target package`.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME libsurefill-dev)
set(CPACK_PACKAGE_CONTACT "The Surefill authors <surefill@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "exact triangle rasterizer - development files")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Surefill rasterizes triangles exactly: coverage is decided on the given
 numbers as real numbers, depth and attributes are correctly rounded, so an
 image has the same bits on every machine. For C++20 and C.
 .
 This package contains the headers and the static library.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS OFF)
if(NOT SUREFILL_REFERENCE_ONLY)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "libhwy-dev")
endif()
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};surefill;engine;/")

# Debian policy: the licence and the changelog of every package.
include(GNUInstallDirs)
set(doc ${CMAKE_INSTALL_DATAROOTDIR}/doc/libsurefill-dev)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Files: *
Copyright: The Surefill authors
License: Apache-2.0
 On Debian systems, the full text is in /usr/share/common-licenses/Apache-2.0.
")
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  OUTPUT_FILE ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/copyright ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz
  DESTINATION ${doc} COMPONENT engine)

include(CPack)
