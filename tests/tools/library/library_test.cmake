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
