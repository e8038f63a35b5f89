# One program of all tests: the files tests/*_test.cpp of every folder, each beside what it tests.
find_package(GTest REQUIRED)
find_package(rapidcheck REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
include(GoogleTest)
set(tests ${PROJECT_SOURCE_DIR})
file(GLOB test_sources CONFIGURE_DEPENDS
  ${tests}/certify/tests/*.cpp ${tests}/corpus/tests/*.cpp ${tests}/engine/tests/*.cpp ${tests}/mutation/tests/*.cpp
  ${tests}/oracle/tests/*.cpp ${tests}/properties/tests/*.cpp ${tests}/textbook/tests/*.cpp)
add_executable(surefill_tests ${test_sources})
target_link_libraries(surefill_tests PRIVATE
  surefill_report surefill_mesh surefill_adapters surefill_zoo_specimens surefill_properties surefill_flags surefill_quick_build GTest::gtest_main rapidcheck rapidcheck_gtest gmpxx gmp)

# define_for(FILE ... DEFINE DEFINITION ...): for these files alone, so that a compiler cache serves all others wherever the tree lies.
function(define_for)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "DEFINE")
  set_property(SOURCE ${arg_UNPARSED_ARGUMENTS} APPEND PROPERTY COMPILE_DEFINITIONS ${arg_DEFINE})
endfunction()
file(GLOB textbook_tests ${tests}/textbook/tests/*.cpp)
define_for(${textbook_tests} ${tests}/corpus/tests/python_words_test.cpp ${tests}/corpus/tests/scene_test.cpp
  ${tests}/engine/tests/attribute_stride_test.cpp ${tests}/engine/tests/hashes_test.cpp
  DEFINE SUREFILL_CORPUS="${PROJECT_SOURCE_DIR}/corpus")
if(SUREFILL_SANITIZE)
  # Instrumented code runs ten to thirty times slower: every test, with a share of its random cases.
  target_compile_definitions(surefill_tests PRIVATE SUREFILL_CASES_SHARE=25)
endif()

# The engine's tests look inside it, and choose instruction sets.
set(white_box ${tests}/engine/tests/batch_bounds_test.cpp ${tests}/engine/tests/internal_bounds_test.cpp)
set_source_files_properties(${white_box} PROPERTIES INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/engine/src)
if(SUREFILL_REFERENCE_ONLY)
  target_compile_definitions(surefill_tests PRIVATE SUREFILL_REFERENCE_ONLY)
else()
  define_for(${tests}/engine/tests/batch_bounds_test.cpp ${tests}/engine/tests/hashes_test.cpp
    ${tests}/engine/tests/paths_test.cpp DEFINE ${SUREFILL_HIGHWAY})
  target_link_libraries(surefill_tests PRIVATE hwy::hwy)
endif()
if(SUREFILL_TBB)
  target_link_libraries(surefill_tests PRIVATE surefill::tbb)
  define_for(${tests}/engine/tests/streaming_test.cpp DEFINE SUREFILL_TBB)
endif()

# Those of the command run the built one, with rivals.
set(test_plugins surefill_engine_plugin surefill_second_plugin surefill_zoo surefill_fixed_point surefill_float_edges
  surefill_stated_model)
add_dependencies(surefill_tests surefill_command surefill_zoo_command ${test_plugins})
foreach(plugin surefill_opengl surefill_vulkan)
  if(TARGET ${plugin})
    add_dependencies(surefill_tests ${plugin})
  endif()
endforeach()
define_for(${tests}/certify/tests/adapter_test.cpp ${tests}/certify/tests/command_test.cpp
  ${tests}/certify/tests/drivers_test.cpp ${tests}/certify/tests/recheck_test.cpp ${tests}/textbook/tests/textbook_docs_test.cpp
  DEFINE SUREFILL_COMMAND="$<TARGET_FILE:surefill_command>"
  SUREFILL_ZOO_COMMAND="$<TARGET_FILE:surefill_zoo_command>"
  SUREFILL_ZOO_PLUGIN="$<TARGET_FILE:surefill_zoo>" SUREFILL_ENGINE_PLUGIN="$<TARGET_FILE:surefill_engine_plugin>"
  SUREFILL_SECOND_PLUGIN="$<TARGET_FILE:surefill_second_plugin>" SUREFILL_STATED_MODEL="$<TARGET_FILE:surefill_stated_model>"
  SUREFILL_FIXED_POINT="$<TARGET_FILE:surefill_fixed_point>" SUREFILL_FLOAT_EDGES="$<TARGET_FILE:surefill_float_edges>"
  SUREFILL_CERTIFICATES="${PROJECT_SOURCE_DIR}/docs/certificates"
  SUREFILL_PYTHON_RIVAL="${PROJECT_SOURCE_DIR}/examples/rivals/rasterizer.py")
gtest_discover_tests(surefill_tests DISCOVERY_TIMEOUT 60)
