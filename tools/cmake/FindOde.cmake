# Debian's libode-dev ships a pkg-config file only; double precision is the packaged build.
find_path(Ode_INCLUDE_DIR ode/ode.h)
find_library(Ode_LIBRARY ode)
if(EXISTS "${Ode_INCLUDE_DIR}/ode/version.h")
  file(STRINGS "${Ode_INCLUDE_DIR}/ode/version.h" Ode_VERSION REGEX "define dODE_VERSION ")
  string(REGEX REPLACE "^[^\"]*\"([^\"]*)\".*$" "\\1" Ode_VERSION "${Ode_VERSION}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ode REQUIRED_VARS Ode_LIBRARY Ode_INCLUDE_DIR
  VERSION_VAR Ode_VERSION)
if(Ode_FOUND AND NOT TARGET Ode::Ode)
  add_library(Ode::Ode UNKNOWN IMPORTED)
  set_target_properties(Ode::Ode PROPERTIES
    IMPORTED_LOCATION "${Ode_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Ode_INCLUDE_DIR}"
    INTERFACE_COMPILE_DEFINITIONS dIDEDOUBLE)
endif()
mark_as_advanced(Ode_INCLUDE_DIR Ode_LIBRARY)
