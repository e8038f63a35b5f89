# SPDX-License-Identifier: Apache-2.0
# The target hwy::hwy: the system's Highway, or the version that everything is tested with, built along.
set(surefill_highway_version 1.0.3)
option(SUREFILL_FETCH_HIGHWAY "Get Highway ${surefill_highway_version} from its repository, where the system has none" OFF)
if(SUREFILL_FETCH_HIGHWAY)
  include(FetchContent)
  set(HWY_ENABLE_CONTRIB OFF CACHE BOOL "")
  set(HWY_ENABLE_EXAMPLES OFF CACHE BOOL "")
  set(HWY_ENABLE_INSTALL OFF CACHE BOOL "")  # cmake/install.cmake does
  set(HWY_ENABLE_TESTS OFF CACHE BOOL "")
  FetchContent_Declare(highway GIT_REPOSITORY https://github.com/google/highway.git GIT_TAG ${surefill_highway_version} GIT_SHALLOW ON)
  FetchContent_MakeAvailable(highway)
  set_target_properties(hwy PROPERTIES POSITION_INDEPENDENT_CODE ON)
  add_library(hwy::hwy ALIAS hwy)
else()
  find_package(hwy QUIET)
  if(NOT hwy_FOUND)
    message(FATAL_ERROR
      "Highway, which the fast path is written in, is not there. Install it (Debian: libhwy-dev), or configure with "
      "-DSUREFILL_FETCH_HIGHWAY=ON, which gets and builds Highway ${surefill_highway_version}, or with "
      "-DSUREFILL_REFERENCE_ONLY=ON, which does without the fast path.")
  endif()
endif()
