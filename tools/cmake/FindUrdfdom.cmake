# Debian's liburdfdom-dev, with its headers among those of the system.
find_path(Urdfdom_INCLUDE_DIR urdf_parser/urdf_parser.h)
find_library(Urdfdom_LIBRARY urdfdom_model)
find_library(Urdfdom_console_LIBRARY console_bridge)
set(Urdfdom_INCLUDE_DIRS ${Urdfdom_INCLUDE_DIR})
set(Urdfdom_LIBRARIES ${Urdfdom_LIBRARY} ${Urdfdom_console_LIBRARY})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Urdfdom
  REQUIRED_VARS Urdfdom_LIBRARY Urdfdom_console_LIBRARY Urdfdom_INCLUDE_DIR)
mark_as_advanced(Urdfdom_INCLUDE_DIR Urdfdom_LIBRARY Urdfdom_console_LIBRARY)
