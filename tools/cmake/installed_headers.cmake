# Runs when the library is installed: headers below the folder `headers` name each other from `parallax/`.
file(GLOB_RECURSE installed "$ENV{DESTDIR}${headers}/*.h")
foreach(header IN LISTS installed)
  file(READ "${header}" text)
  string(REGEX REPLACE "#include \"(compiler|harness|runtime|tools)/" "#include \"parallax/\\1/" named "${text}")
  if(NOT named STREQUAL text)
    file(WRITE "${header}" "${named}")
  endif()
endforeach()
