# One interface target carries the warnings; they are errors only in the ci-* presets.
add_library(parallax_warnings INTERFACE)
target_compile_options(parallax_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wswitch-enum -Wold-style-cast -Wnon-virtual-dtor)
# g++ 12 warns of impossible string copies at -O3 (its bugs 105329 and 105651).
target_compile_options(parallax_warnings INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
# Bitwise replay: no contraction into fused multiply-add, whatever the compiler's default.
target_compile_options(parallax_warnings INTERFACE -ffp-contract=off)

# parallax_library(NAME SOURCES a.cc ... DEPENDS lib ... [PRIVATE_DEPENDS lib ...])
# A static library parallax_NAME, alias parallax::NAME, with includes rooted at the repository.
function(parallax_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(parallax_${name} STATIC ${arg_SOURCES})
  add_library(parallax::${name} ALIAS parallax_${name})
  target_include_directories(parallax_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(parallax_${name} PUBLIC ${arg_DEPENDS}
                        PRIVATE parallax_warnings ${arg_PRIVATE_DEPENDS})
endfunction()

# parallax_test(NAME SOURCES a_test.cc ... DEPENDS lib ... [LABELS fast])
# A doctest binary, registered with CTest as one test per suite file.
function(parallax_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  add_executable(${name} ${arg_SOURCES} ${PROJECT_SOURCE_DIR}/tests/doctest_main.cc)
  target_link_libraries(${name} PRIVATE ${arg_DEPENDS} doctest::doctest parallax_warnings)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE
    PARALLAX_SOURCE_DIR="${PROJECT_SOURCE_DIR}" PARALLAX_BINARY_DIR="${PROJECT_BINARY_DIR}")
  add_test(NAME ${name} COMMAND ${name})
  if(NOT arg_LABELS)
    set(arg_LABELS fast)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT 600)
endfunction()
