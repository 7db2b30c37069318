# Debian's libassimp-dev and libqhull-dev (the reentrant library). Target names in their package files differ
# between versions, so only folders and file names are used.
find_path(Meshes_assimp_INCLUDE_DIR assimp/Importer.hpp)
find_library(Meshes_assimp_LIBRARY assimp)
find_path(Meshes_qhull_INCLUDE_DIR libqhull_r/qhull_ra.h)
find_library(Meshes_qhull_LIBRARY qhull_r)
set(Meshes_INCLUDE_DIRS ${Meshes_assimp_INCLUDE_DIR} ${Meshes_qhull_INCLUDE_DIR})
set(Meshes_LIBRARIES ${Meshes_assimp_LIBRARY} ${Meshes_qhull_LIBRARY})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Meshes
  REQUIRED_VARS Meshes_assimp_LIBRARY Meshes_assimp_INCLUDE_DIR Meshes_qhull_LIBRARY
    Meshes_qhull_INCLUDE_DIR)
mark_as_advanced(Meshes_assimp_INCLUDE_DIR Meshes_assimp_LIBRARY Meshes_qhull_INCLUDE_DIR
  Meshes_qhull_LIBRARY)
