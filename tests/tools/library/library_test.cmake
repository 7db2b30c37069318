# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P library_test.cmake
# Installs the build into a prefix of its own, builds the example of docs/library against it as
# somebody else would, runs it and compares what it prints.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out ERROR_VARIABLE out)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE}/docs/library -B ${WORK}/build -DCMAKE_BUILD_TYPE=Debug
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
