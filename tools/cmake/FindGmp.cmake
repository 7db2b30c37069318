# Debian's libgmp-dev has no CMake package file.
find_path(Gmp_INCLUDE_DIR gmpxx.h)
find_library(Gmp_LIBRARY gmp)
find_library(Gmpxx_LIBRARY gmpxx)
# On Debian, gmp.h lies in a folder for the architecture.
find_path(Gmp_C_INCLUDE_DIR gmp.h)
set(Gmp_VERSION "")
if(Gmp_C_INCLUDE_DIR)
  foreach(part "" _MINOR _PATCHLEVEL)
    file(STRINGS "${Gmp_C_INCLUDE_DIR}/gmp.h" line REGEX "define __GNU_MP_VERSION${part} +[0-9]+")
    string(REGEX MATCH "[0-9]+" number "${line}")
    list(APPEND Gmp_VERSION "${number}")
  endforeach()
  list(JOIN Gmp_VERSION "." Gmp_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Gmp REQUIRED_VARS Gmp_LIBRARY Gmpxx_LIBRARY Gmp_INCLUDE_DIR
  VERSION_VAR Gmp_VERSION)
if(Gmp_FOUND AND NOT TARGET Gmp::Gmp)
  add_library(Gmp::Gmp UNKNOWN IMPORTED)
  set_target_properties(Gmp::Gmp PROPERTIES
    IMPORTED_LOCATION "${Gmpxx_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Gmp_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${Gmp_LIBRARY}")
endif()
mark_as_advanced(Gmp_C_INCLUDE_DIR Gmp_INCLUDE_DIR Gmp_LIBRARY Gmpxx_LIBRARY)
