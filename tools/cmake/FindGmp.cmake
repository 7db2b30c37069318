# Debian's libgmp-dev has no CMake package file.
find_path(Gmp_INCLUDE_DIR gmpxx.h)
find_library(Gmp_LIBRARY gmp)
find_library(Gmpxx_LIBRARY gmpxx)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Gmp REQUIRED_VARS Gmp_LIBRARY Gmpxx_LIBRARY Gmp_INCLUDE_DIR)
if(Gmp_FOUND AND NOT TARGET Gmp::Gmp)
  add_library(Gmp::Gmp UNKNOWN IMPORTED)
  set_target_properties(Gmp::Gmp PROPERTIES
    IMPORTED_LOCATION "${Gmpxx_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Gmp_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${Gmp_LIBRARY}")
endif()
mark_as_advanced(Gmp_INCLUDE_DIR Gmp_LIBRARY Gmpxx_LIBRARY)
