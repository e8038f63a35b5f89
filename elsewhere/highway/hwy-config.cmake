# SPDX-License-Identifier: Apache-2.0
# Highway's headers alone, as libhwy-dev has them on any machine, for machines that its library is not built for: which vectors are
# used, the compiler's options say. SUREFILL_HIGHWAY_HEADERS is a folder that holds the folder hwy.
add_library(hwy::hwy INTERFACE IMPORTED)
set_target_properties(hwy::hwy PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES ${SUREFILL_HIGHWAY_HEADERS}
  INTERFACE_COMPILE_DEFINITIONS HWY_COMPILE_ONLY_STATIC)
