# cmake -DPROGRAM=... -P start_loads_test.cmake
# A start loads no library that only some worlds need: libsdformat alone takes 15 ms.
execute_process(COMMAND ${CMAKE_COMMAND} -E env LD_DEBUG=files ${PROGRAM} --version
  ERROR_VARIABLE loaded OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
if(NOT loaded MATCHES "libfmt")
  message(FATAL_ERROR "the dynamic linker does not say what it loads:\n${loaded}")
endif()
if(loaded MATCHES "sdformat|ignition")
  message(FATAL_ERROR "a start loads ${CMAKE_MATCH_0}")
endif()
