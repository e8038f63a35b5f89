# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts: the engine alone. Headers, library, CMake package, pkg-config file.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(surefill_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/surefill)

# What a program needs besides libsurefill.a; the shared library brings its own.
get_target_property(surefill_type surefill TYPE)
set(surefill_dependencies "")
set(surefill_link_flags "")
if(surefill_type STREQUAL STATIC_LIBRARY)
  set(surefill_link_flags "-lstdc++ -lm")
  if(NOT SUREFILL_REFERENCE_ONLY)
    set(surefill_dependencies "find_dependency(Threads)")
    set(surefill_link_flags "-lhwy -pthread ${surefill_link_flags}")
    if(SUREFILL_FETCH_HIGHWAY)
      install(TARGETS hwy EXPORT surefill ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT engine)
    else()
      string(PREPEND surefill_dependencies "find_dependency(hwy)\n")
    endif()
  endif()
endif()
if(SUREFILL_TBB)
  install(TARGETS surefill_tbb EXPORT surefill FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT engine)
  string(APPEND surefill_dependencies "\nfind_dependency(TBB)")
endif()
file(RELATIVE_PATH surefill_pc_prefix /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)  # so that the tree can be moved
set(surefill_pc_dirs "includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}\nlibdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}")

install(TARGETS surefill EXPORT surefill
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT engine
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT engine
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT engine
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT engine)
install(EXPORT surefill NAMESPACE surefill:: FILE surefill-targets.cmake
  DESTINATION ${surefill_package_dir} COMPONENT engine)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/surefill-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/surefill-config.cmake INSTALL_DESTINATION ${surefill_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/surefill-config-version.cmake
  COMPATIBILITY SameMinorVersion)
configure_file(${PROJECT_SOURCE_DIR}/cmake/surefill.pc.in ${CMAKE_CURRENT_BINARY_DIR}/surefill.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/surefill-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/surefill-config-version.cmake
  DESTINATION ${surefill_package_dir} COMPONENT engine)
install(FILES ${PROJECT_SOURCE_DIR}/docs/semantics.md  # the rules that the headers cite
  DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/surefill COMPONENT engine)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/surefill.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT engine)
