# Debian's libsdformat-dev. Its own package file looks for build tools that are not needed here, and
# its flags ask for an older C++; of them only folders and names are taken.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(Sdformat_pc QUIET sdformat12)
endif()
set(Sdformat_INCLUDE_DIRS ${Sdformat_pc_INCLUDE_DIRS})
set(Sdformat_LIBRARIES ${Sdformat_pc_LINK_LIBRARIES})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Sdformat REQUIRED_VARS Sdformat_LIBRARIES Sdformat_INCLUDE_DIRS)
