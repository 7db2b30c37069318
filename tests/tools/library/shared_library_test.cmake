# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P shared_library_test.cmake
# Installs the build into a prefix of its own, builds the programs of docs/guide/library/shared against the shared library as
# somebody else would, runs them, and looks at what the library shows.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out ERROR_VARIABLE out)
endfunction()
function(expect code text)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE printed ERROR_VARIABLE printed
    RESULT_VARIABLE ended)
  if(NOT ended EQUAL code OR NOT printed MATCHES "${text}")
    message(FATAL_ERROR "${ARGN}\nended with ${ended} instead of ${code} and printed\n${printed}\nwithout ${text}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE}/docs/guide/library/shared -B ${WORK}/build -DCMAKE_BUILD_TYPE=Debug
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_FLAGS=-Werror)
run(${CMAKE_COMMAND} --build ${WORK}/build)

set(regions ${SOURCE}/scenarios/two_regions)
expect(1 "discrepancy\ntrace 1, simulation [0-9]+, timepoint 4: " ${WORK}/build/line_world ${regions}/edge.yaml ${WORK}/edge)
expect(0 "fewer than 5 % of start states" ${WORK}/build/line_world ${regions}/scenario.yaml ${WORK}/clean)
expect(3 "error.E" ${WORK}/build/line_world ${regions}/nothing.yaml ${WORK}/nothing)
# What the run left behind is read by the program.
expect(0 "" ${BUILD}/parallax report ${WORK}/edge -o ${WORK}/edge.html)

# As many as the program counts.
file(READ ${regions}/domain.e domain)
file(READ ${regions}/start.e start)
file(WRITE ${WORK}/three.e "${domain}\n${start}\nrange time 0 3\n")
execute_process(COMMAND ${BUILD}/parallax traces ${WORK}/three.e --count OUTPUT_VARIABLE counted
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
expect(0 "^${counted} traces, counted and listed alike by four threads" ${WORK}/build/four_threads ${WORK}/three.e)
expect(0 "^${counted}\n" ${WORK}/build/host ${WORK}/build/counter.so ${WORK}/three.e)
expect(3 "error" ${WORK}/build/host ${WORK}/build/counter.so ${WORK}/none.e)

# The contract of every function of a client that is called, by a client that pkg-config builds. It has a
# `runtime` folder of its own, which the library's headers must not hide.
find_program(pkg_config pkg-config REQUIRED)
file(GLOB_RECURSE pc ${WORK}/prefix/libparallax.pc)
cmake_path(GET pc PARENT_PATH pc)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} ${pkg_config} --cflags --libs libparallax
  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
cmake_path(GET pc PARENT_PATH library)
file(WRITE ${WORK}/own/runtime/trace/trace.h "#define OWN_HEADER 1\n")
file(WRITE ${WORK}/main.h "#include \"runtime/trace/trace.h\"\n#if OWN_HEADER != 1\n#error another header\n#endif\n")
run(c++ -std=c++20 -Wall -Wextra -Werror ${SOURCE}/tests/tools/library/callbacks.cc -o ${WORK}/callbacks ${flags}
    -I${WORK}/own -include ${WORK}/main.h -Wl,-rpath,${library})
expect(0 "^all hold" ${WORK}/callbacks ${regions}/scenario.yaml ${WORK}/three.e ${WORK}/callbacks.out)

# The interface, and nothing of the house, is seen from outside.
file(GLOB_RECURSE library ${WORK}/prefix/libparallax.so)
execute_process(COMMAND nm -D --defined-only -C ${library} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "(^|\n)[0-9a-f]+ . " "\\1" names "${symbols}")
file(STRINGS ${SOURCE}/tests/tools/library/exports.txt expected ENCODING UTF-8)
string(STRIP "${names}" names)
string(REPLACE ";" "%" names "${names}")
string(REPLACE "\n" ";" names "${names}")
list(SORT names)
list(REMOVE_DUPLICATES names)
list(JOIN names "\n" names)
list(JOIN expected "\n" expected)
if(NOT names STREQUAL expected)
  file(WRITE ${WORK}/exports.txt "${names}\n")
  message(FATAL_ERROR "libparallax.so shows other symbols than tests/tools/library/exports.txt lists: see "
    "${WORK}/exports.txt. A symbol that goes, or that changes, needs another SOVERSION.")
endif()
