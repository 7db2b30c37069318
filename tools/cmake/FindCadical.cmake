# Debian's libcadical-dev is a static library without CMake or pkg-config files.
find_path(Cadical_INCLUDE_DIR cadical.hpp)
find_library(Cadical_LIBRARY cadical)
# The packaged library reports version sc2021, so dpkg is asked for the package's version.
execute_process(COMMAND dpkg-query -W -f=\${Version} libcadical-dev
                OUTPUT_VARIABLE Cadical_VERSION ERROR_QUIET)
if(NOT Cadical_VERSION)
  set(Cadical_VERSION unknown)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cadical REQUIRED_VARS Cadical_LIBRARY Cadical_INCLUDE_DIR)
if(Cadical_FOUND AND NOT TARGET Cadical::Cadical)
  add_library(Cadical::Cadical UNKNOWN IMPORTED)
  set_target_properties(Cadical::Cadical PROPERTIES
    IMPORTED_LOCATION "${Cadical_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Cadical_INCLUDE_DIR}")
endif()
mark_as_advanced(Cadical_INCLUDE_DIR Cadical_LIBRARY)
