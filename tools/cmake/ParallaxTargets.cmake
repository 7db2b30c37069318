# One interface target carries the warnings; they are errors only in the ci-* presets.
add_library(parallax_warnings INTERFACE)
target_compile_options(parallax_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wswitch-enum -Wold-style-cast -Wnon-virtual-dtor)
# g++ 12 warns of impossible string copies at -O3 (its bugs 105329 and 105651).
target_compile_options(parallax_warnings INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
# g++ collects its garbage only beyond 500 MB: 5 to 10 % less processor time, four at a time 2 GB.
target_compile_options(parallax_warnings INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=500000>)
# All code may go into the shared library, which shows its interface only: with both options it is as fast as without.
target_compile_options(parallax_warnings INTERFACE -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
# Bitwise replay: no contraction into fused multiply-add, whatever the compiler's default.
target_compile_options(parallax_warnings INTERFACE -ffp-contract=off)
# Broken contracts name files as the repository does, wherever it lay when it was compiled.
target_compile_options(parallax_warnings INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)

# Sources that follow one another are compiled together, up to so many bytes of text: a batch pays 4 to 5 s for
# headers and as much for templates that others make as well, before its own code. The size is a compromise:
# larger batches build everything faster, smaller ones a single changed file.
set(PARALLAX_BATCH 400000 CACHE STRING "Sources compiled together, in bytes; 0: each alone")
set(PARALLAX_TEST_BATCH 80000 CACHE STRING "Sources of one test compiled together, in bytes; 0: each alone")

# parallax_batches(TARGET BYTES a.cc ...): file-local names must differ within a target.
function(parallax_batches target size_limit)
  if(size_limit EQUAL 0)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set(batch 0)
  set(bytes 0)
  foreach(source ${ARGN})
    cmake_path(ABSOLUTE_PATH source)
    file(SIZE ${source} size)
    math(EXPR bytes "${bytes} + ${size}")
    if(bytes GREATER size_limit)
      math(EXPR batch "${batch} + 1")
      set(bytes ${size})
    endif()
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${target}_${batch})
  endforeach()
endfunction()

# Cold rooms, and programs where PARALLAX_COLD is set, are compiled with -O1: they read and write text, call Eigen, and wait
# for solvers and simulators. It saves a fifth of their compile time.
function(parallax_optimize target)
  if(PARALLAX_COLD)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    parallax_use_precompiled(${target} cold)
  else()
    parallax_use_precompiled(${target} hot)
  endif()
endfunction()

# What nearly every source reads first is parsed once for each set of compile options, `hot` and `cold`, and not in each
# batch. Only where code is optimized: fmt's headers switch optimization on for themselves, and g++ 12 goes on
# after a precompiled one as if it were (Eigen then does not compile). Not for tests: g++ 12 forgets in a precompiled header
# that code is the standard library's, and warns of impossible copies of their short constant strings.
option(PARALLAX_PRECOMPILE "Parse the standard headers once" ON)
if(CMAKE_BUILD_TYPE STREQUAL Debug)
  set(PARALLAX_PRECOMPILE OFF)
endif()
function(parallax_precompile kind)
  if(NOT PARALLAX_PRECOMPILE)
    return()
  endif()
  set(made parallax_precompiled_${kind})
  add_library(${made} OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tools/cmake/precompiled.cc)
  target_link_libraries(${made} PRIVATE parallax_warnings fmt::fmt Eigen3::Eigen nlohmann_json::nlohmann_json)
  target_precompile_headers(${made} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional>
    <map> <memory> <optional> <set> <span> <string> <string_view> <tuple> <unordered_map> <utility> <variant>
    <vector> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp> <Eigen/Geometry>)
  if(kind STREQUAL cold)
    target_compile_options(${made} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()

# The headers of tests that only start the program, which are not optimized. fmt is not among them: see above.
function(parallax_precompile_for_tests)
  if(NOT PARALLAX_PRECOMPILE)
    return()
  endif()
  add_library(parallax_precompiled_test OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tools/cmake/precompiled.cc)
  target_link_libraries(parallax_precompiled_test PRIVATE parallax_warnings fmt::fmt nlohmann_json::nlohmann_json
    doctest::doctest)
  target_compile_options(parallax_precompiled_test PRIVATE ${PARALLAX_PLAIN_TEST})
  target_compile_definitions(parallax_precompiled_test PRIVATE ${PARALLAX_TEST_DEFINITIONS})
  target_precompile_headers(parallax_precompiled_test PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem>
    <fstream> <functional> <map> <memory> <optional> <regex> <set> <span> <sstream> <string> <string_view> <tuple>
    <unordered_map> <utility> <variant> <vector> <nlohmann/json.hpp> <doctest/doctest.h>)
endfunction()

function(parallax_use_precompiled target kind)
  if(PARALLAX_PRECOMPILE)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)  # its definitions have to be the same
    target_precompile_headers(${target} REUSE_FROM parallax_precompiled_${kind})
  endif()
endfunction()

# parallax_room(NAME [COLD] FOLDERS folder ...): one static library parallax_NAME of several folders, which
# are compiled together. Each folder says in its own CMakeLists.txt what it is made of and what it may
# include (parallax_folder), as if it were a library of its own; tests/tools/layering_test.cc holds it to that.
# Rooms are few because each batch pays for its headers, and because linkers and readers do as well.
function(parallax_room name)
  cmake_parse_arguments(arg "COLD" "" "FOLDERS" ${ARGN})
  set(room parallax_${name})
  add_library(${room} STATIC)
  target_include_directories(${room} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${room} PRIVATE $<BUILD_INTERFACE:parallax_warnings>)
  target_compile_features(${room} PUBLIC cxx_std_20)
  set_target_properties(${room} PROPERTIES EXPORT_NAME ${name})
  set(PARALLAX_COLD ${arg_COLD})
  parallax_optimize(${room})
  set(PARALLAX_ROOM ${room})
  foreach(folder ${arg_FOLDERS})
    add_subdirectory(${folder})
  endforeach()
  get_target_property(sources ${room} PARALLAX_SOURCES)
  parallax_batches(${room} ${PARALLAX_BATCH} ${sources})
  foreach(scope PUBLIC PRIVATE)
    get_property(libraries TARGET ${room} PROPERTY PARALLAX_${scope})
    list(REMOVE_DUPLICATES libraries)
    foreach(library ${libraries})
      if(TARGET ${library})
        get_target_property(aliased ${library} ALIASED_TARGET)
        if(aliased)
          set(library ${aliased})
        endif()
      endif()
      if(NOT library STREQUAL room)
        target_link_libraries(${room} ${scope} ${library})
      endif()
    endforeach()
  endforeach()
endfunction()

# parallax_folder(NAME SOURCES a.cc ... DEPENDS folder-or-library ... [PRIVATE_DEPENDS ...])
# A folder of the room that is being made, alias parallax::NAME, with includes rooted at the repository.
# DEPENDS and PRIVATE_DEPENDS are the house's layers: what the folder may include, and no more.
function(parallax_folder name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  target_sources(${PARALLAX_ROOM} PRIVATE ${sources})
  add_library(parallax::${name} ALIAS ${PARALLAX_ROOM})
  set_property(TARGET ${PARALLAX_ROOM} APPEND PROPERTY PARALLAX_SOURCES ${sources})
  set_property(TARGET ${PARALLAX_ROOM} APPEND PROPERTY PARALLAX_PUBLIC ${arg_DEPENDS})
  set_property(TARGET ${PARALLAX_ROOM} APPEND PROPERTY PARALLAX_PRIVATE ${arg_PRIVATE_DEPENDS})
  parallax_headers(${PARALLAX_ROOM} ${arg_SOURCES})
  parallax_record_layer(parallax::${name} "${arg_SOURCES}" "${arg_DEPENDS};${arg_PRIVATE_DEPENDS}")
endfunction()

# parallax_library(NAME SOURCES a.cc ... DEPENDS lib ... [PRIVATE_DEPENDS lib ...])
# A static library parallax_NAME, alias parallax::NAME, with includes rooted at the repository.
# DEPENDS and PRIVATE_DEPENDS are the house's layers: what the folder may include, and no more
# (tests/tools/layering_test.cc reads them from the file that parallax_write_layers writes).
function(parallax_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(parallax_${name} STATIC ${arg_SOURCES})
  add_library(parallax::${name} ALIAS parallax_${name})
  target_include_directories(parallax_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(parallax_${name} PUBLIC ${arg_DEPENDS}
                        PRIVATE $<BUILD_INTERFACE:parallax_warnings> ${arg_PRIVATE_DEPENDS})
  target_compile_features(parallax_${name} PUBLIC cxx_std_20)
  set_target_properties(parallax_${name} PROPERTIES EXPORT_NAME ${name})
  parallax_optimize(parallax_${name})
  parallax_batches(parallax_${name} ${PARALLAX_BATCH} ${arg_SOURCES})
  parallax_headers(parallax_${name} ${arg_SOURCES})
  parallax_record_layer(parallax::${name} "${arg_SOURCES}" "${arg_DEPENDS};${arg_PRIVATE_DEPENDS}")
endfunction()

# The headers that lie beside the sources, as a file set: what is installed, and what the preset
# `headers` compiles one by one. A header belongs to the first library of its folder.
function(parallax_headers target)
  set(headers "")
  foreach(source ${ARGN})
    cmake_path(GET source PARENT_PATH folder)
    file(GLOB beside CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.h)
    list(APPEND headers ${beside})
  endforeach()
  list(REMOVE_DUPLICATES headers)
  get_property(taken GLOBAL PROPERTY parallax_headers)
  list(REMOVE_ITEM headers "" ${taken})
  set_property(GLOBAL APPEND PROPERTY parallax_headers ${headers})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})
endfunction()

# parallax_module_headers(LIBRARY a.h ...): headers of a module alone, which include LIBRARY's. Called before the folder
# that they lie in, which would install them otherwise. The preset `headers` compiles them where LIBRARY is there.
function(parallax_module_headers library)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(GLOBAL APPEND PROPERTY parallax_headers ${ARGN})
  if(TARGET ${library})
    string(MAKE_C_IDENTIFIER headers_of_${library} name)
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} INTERFACE ${library} Eigen3::Eigen)
    target_sources(${name} INTERFACE FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARGN})
  endif()
endfunction()

# parallax_install_library(LIBRARY): exports the interface library with everything below it, so that
# `find_package(parallax)` finds it. Headers lie in include/parallax, by their folders in the repository, and name each
# other as clients name them: `parallax/runtime/...`. So no folder of a client is hidden, and none hides theirs.
function(parallax_install_library library)
  set(open ${library})
  set(below "")
  while(open)
    list(POP_FRONT open target)
    get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
    foreach(link ${links})
      string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" name "${link}")
      if(TARGET "${name}")
        get_target_property(aliased ${name} ALIASED_TARGET)
        if(aliased)
          set(name ${aliased})
        endif()
      endif()
      if(name MATCHES "^parallax_" AND NOT name IN_LIST below)
        list(APPEND below ${name})
        list(APPEND open ${name})
      endif()
    endforeach()
  endwhile()
  set(config ${CMAKE_INSTALL_LIBDIR}/cmake/parallax)
  install(TARGETS ${library} ${below} EXPORT parallaxTargets COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/parallax COMPONENT development
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/parallax COMPONENT development)
  install(CODE "set(headers \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/parallax\")"
    COMPONENT development)
  install(SCRIPT ${PROJECT_SOURCE_DIR}/tools/cmake/installed_headers.cmake COMPONENT development)
  install(EXPORT parallaxTargets NAMESPACE parallax:: DESTINATION ${config} COMPONENT development)
  include(CMakePackageConfigHelpers)
  set(modules ${PROJECT_SOURCE_DIR}/tools/cmake)
  set(made ${PROJECT_BINARY_DIR}/generated/parallaxConfig)
  set(exported "")
  foreach(name ${library} ${below})
    get_target_property(name ${name} EXPORT_NAME)
    string(APPEND exported " parallax::${name}")
  endforeach()
  set(headers ${CMAKE_INSTALL_INCLUDEDIR})
  configure_package_config_file(${modules}/parallaxConfig.cmake.in ${made}.cmake
    INSTALL_DESTINATION ${config} PATH_VARS headers)
  write_basic_package_version_file(${made}Version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${made}.cmake ${made}Version.cmake ${modules}/FindCadical.cmake
    ${modules}/FindGmp.cmake ${modules}/FindOde.cmake DESTINATION ${config}
    COMPONENT development)
  # The same for pkg-config. The libraries need each other in no order that a line could have.
  set(PARALLAX_PC_LIBS "")
  foreach(name ${below})
    get_target_property(type ${name} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      string(APPEND PARALLAX_PC_LIBS " -l${name}")
    endif()
  endforeach()
  set(PARALLAX_PC_MORE "-lcadical")
  get_target_property(readers parallax_world COMPILE_DEFINITIONS)
  if("PARALLAX_HAS_URDFDOM" IN_LIST readers)
    string(APPEND PARALLAX_PC_MORE " -lurdfdom_model -lconsole_bridge")
  endif()
  file(RELATIVE_PATH PARALLAX_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
    ${CMAKE_INSTALL_PREFIX})
  configure_file(${modules}/parallax.pc.in ${PROJECT_BINARY_DIR}/generated/parallax.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/generated/parallax.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endfunction()

# parallax_program(NAME SOURCES a.cc ... DEPENDS lib ...): an executable, which is a layer as well.
function(parallax_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${arg_DEPENDS} parallax_warnings)
  parallax_optimize(${name})
  parallax_batches(${name} ${PARALLAX_BATCH} ${arg_SOURCES})
  parallax_record_layer(${name} "${arg_SOURCES}" "${arg_DEPENDS}")
endfunction()

function(parallax_record_layer name sources depends)
  set(folders "")
  foreach(source ${sources})
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR}
               OUTPUT_VARIABLE folder)
    cmake_path(APPEND folder ${source})
    cmake_path(GET folder PARENT_PATH folder)
    list(APPEND folders ${folder})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  list(JOIN depends " " depends)
  foreach(folder ${folders})
    set_property(GLOBAL APPEND_STRING PROPERTY parallax_layers "${folder} ${name} ${depends}\n")
  endforeach()
endfunction()

# One line each folder and library or program in it: the folder, the name, what it depends on.
function(parallax_write_layers)
  get_property(layers GLOBAL PROPERTY parallax_layers)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/layers.txt CONTENT "${layers}" @ONLY)
endfunction()

set(PARALLAX_TEST_DEFINITIONS DOCTEST_CONFIG_SUPER_FAST_ASSERTS
  PARALLAX_SOURCE_DIR="${PROJECT_SOURCE_DIR}" PARALLAX_BINARY_DIR="${PROJECT_BINARY_DIR}")
# Tests are compiled more often than they run; what they link keeps its own options. Without any optimization their
# copies of inline functions would take the place of the libraries': only where they just start the program.
set(PARALLAX_PLAIN_TEST $<IF:$<CONFIG:Release>,-O0,-O1>)

# parallax_test(NAME SOURCES a_test.cc ... DEPENDS lib ... [LABELS fast])
# A doctest binary, registered with CTest as one test per suite file.
function(parallax_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  add_executable(${name} ${arg_SOURCES} $<TARGET_OBJECTS:parallax_doctest_main>)
  target_link_libraries(${name} PRIVATE
    ${arg_DEPENDS} parallax_test_support doctest::doctest parallax_warnings)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  parallax_batches(${name} ${PARALLAX_TEST_BATCH} ${arg_SOURCES})
  target_compile_definitions(${name} PRIVATE ${PARALLAX_TEST_DEFINITIONS})
  if("parallax_cli_fixture" IN_LIST arg_DEPENDS AND NOT "oracle" IN_LIST arg_LABELS)
    target_compile_options(${name} PRIVATE ${PARALLAX_PLAIN_TEST})
    if(CMAKE_BUILD_TYPE STREQUAL Release)
      parallax_use_precompiled(${name} test)
    endif()
  else()
    target_compile_options(${name} PRIVATE -O1)
  endif()
  add_test(NAME ${name} COMMAND ${name})
  if(NOT arg_LABELS)
    set(arg_LABELS fast)
  endif()
  # Python is Debian's, whose modules tools/packages has: a version manager's stand-in starts thirty processes each time.
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT 600
    ENVIRONMENT_MODIFICATION "PATH=path_list_prepend:/usr/bin")
  if("fast" IN_LIST arg_LABELS)
    add_dependencies(fast_tests ${name})
  endif()
endfunction()

# parallax_module(NAME LOADED_BY TARGET SOURCES FILE... LIBRARIES LIBRARY...): what is loaded while the program runs,
# by a library of it. It has all that it calls, which a linker does not ask by itself; sanitizers leave their own
# functions to the program. Nor does it tell where it was built.
function(parallax_module name)
  cmake_parse_arguments(arg "" "LOADED_BY" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} MODULE ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE parallax_warnings Eigen3::Eigen fmt::fmt ${arg_LIBRARIES})
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON BUILD_RPATH "" INSTALL_RPATH "" UNITY_BUILD OFF
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/modules)
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    target_link_options(${name} PRIVATE -Wl,--no-undefined)
  endif()
  add_dependencies(${arg_LOADED_BY} ${name})
  install(TARGETS ${name} COMPONENT program LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/parallax)
endfunction()
