# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P library_test.cmake
# Installs the build into a prefix of its own, builds the example of docs/guide/library against it as
# somebody else would, runs it and compares what it prints.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out ERROR_VARIABLE out)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE}/docs/guide/library -B ${WORK}/build -DCMAKE_BUILD_TYPE=Debug
    -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
execute_process(COMMAND ${WORK}/build/example scenarios/two_regions/edge.yaml
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ ${SOURCE}/tests/tools/library/expected.txt expected)
if(NOT printed STREQUAL expected)
  message(FATAL_ERROR "the example printed\n${printed}instead of\n${expected}")
endif()
execute_process(COMMAND ${WORK}/build/example RESULT_VARIABLE code ERROR_QUIET)
if(NOT code EQUAL 2)
  message(FATAL_ERROR "the example without a scenario ended with ${code}")
endif()

# A client of pkg-config has folders as the repository has them: neither hides headers of the other.
file(WRITE ${WORK}/own/runtime/trace/trace.h "#define OWN_HEADER 1\n")
file(WRITE ${WORK}/main.h "#include \"runtime/trace/trace.h\"\n#if OWN_HEADER != 1\n#error another header\n#endif\n")
find_program(pkg_config pkg-config REQUIRED)
file(GLOB_RECURSE pc ${WORK}/prefix/parallax.pc)
cmake_path(GET pc PARENT_PATH pc)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} ${pkg_config} --cflags --libs parallax
  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
set(client -std=c++20 -include ${WORK}/main.h ${SOURCE}/docs/guide/library/example.cc)
run(c++ ${client} -o ${WORK}/by_pkg_config -I${WORK}/own ${flags})
run(c++ ${client} -fsyntax-only ${flags} -I${WORK}/own)
file(GLOB_RECURSE made ${WORK}/build/flags.make ${WORK}/build/build.ninja)
file(STRINGS "${made}" hiding REGEX "${WORK}/prefix/include/parallax( |$)")
if(NOT made OR hiding)
  message(FATAL_ERROR "clients of CMake look for headers in include/parallax: ${hiding}")
endif()

# What the library is for is installed with it.
foreach(page library.md examples/example.cc examples/CMakeLists.txt)
  if(NOT EXISTS ${WORK}/prefix/share/doc/libparallax-dev/${page})
    message(FATAL_ERROR "the library's ${page} is not installed")
  endif()
endforeach()

# The installed program finds the modules it came with, also from another folder.
file(GLOB modules RELATIVE ${BUILD}/modules ${BUILD}/modules/parallax_*.so)
foreach(module ${modules})
  file(GLOB_RECURSE installed ${WORK}/prefix/*/${module})
  file(GLOB program ${WORK}/prefix/bin/parallax)
  if(NOT installed OR NOT program)
    message(FATAL_ERROR "the module ${module}, or the program, is not installed")
  endif()
  execute_process(COMMAND readelf -d ${program} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
  cmake_path(GET installed PARENT_PATH folder)
  file(RELATIVE_PATH folder ${WORK}/prefix/bin ${folder})
  string(FIND "${dynamic}" "[$ORIGIN/${folder}]" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "the installed program does not look into $ORIGIN/${folder}:\n${dynamic}")
  endif()
endforeach()
