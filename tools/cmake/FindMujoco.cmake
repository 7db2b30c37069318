# Debian's libmujoco-dev. The engine calls MuJoCo's stages one by one, which change between release series, so
# only the tested series is accepted.
find_path(Mujoco_INCLUDE_DIR mujoco/mujoco.h)
find_library(Mujoco_LIBRARY mujoco)
if(EXISTS "${Mujoco_INCLUDE_DIR}/mujoco/mujoco.h")
  file(STRINGS "${Mujoco_INCLUDE_DIR}/mujoco/mujoco.h" number REGEX "define mjVERSION_HEADER ")
  string(REGEX REPLACE "^.* ([0-9])([0-9]+)([0-9])$" "\\1.\\2.\\3" Mujoco_VERSION "${number}")
endif()
set(Mujoco_SERIES "")
if(Mujoco_VERSION VERSION_GREATER_EQUAL 2.2.2 AND Mujoco_VERSION VERSION_LESS 2.3)
  set(Mujoco_SERIES ${Mujoco_VERSION})
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Mujoco
  REQUIRED_VARS Mujoco_LIBRARY Mujoco_INCLUDE_DIR Mujoco_SERIES VERSION_VAR Mujoco_VERSION)
if(Mujoco_FOUND AND NOT TARGET Mujoco::Mujoco)
  add_library(Mujoco::Mujoco UNKNOWN IMPORTED)
  set_target_properties(Mujoco::Mujoco PROPERTIES
    IMPORTED_LOCATION "${Mujoco_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Mujoco_INCLUDE_DIR}")
endif()
mark_as_advanced(Mujoco_INCLUDE_DIR Mujoco_LIBRARY)
