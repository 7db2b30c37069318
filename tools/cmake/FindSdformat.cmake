# Debian's libsdformat-dev. Its package file looks for build tools that are not needed here, and its flags ask
# for an older C++, so only folders and file names are used.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(Sdformat_pc QUIET sdformat12)
endif()
set(Sdformat_INCLUDE_DIRS ${Sdformat_pc_INCLUDE_DIRS})
set(Sdformat_LIBRARIES ${Sdformat_pc_LINK_LIBRARIES})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Sdformat REQUIRED_VARS Sdformat_LIBRARIES Sdformat_INCLUDE_DIRS)
