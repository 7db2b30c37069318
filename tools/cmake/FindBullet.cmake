# Debian's libbullet-dev, in double precision. CMake has a module of that name, which knows the libraries in single
# precision only.
find_path(Bullet_INCLUDE_DIR btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
set(Bullet_LIBRARIES "")
foreach(part BulletDynamics BulletCollision LinearMath)
  find_library(Bullet_${part} ${part}-float64)
  mark_as_advanced(Bullet_${part})
  list(APPEND Bullet_LIBRARIES "${Bullet_${part}}")
endforeach()
if(EXISTS "${Bullet_INCLUDE_DIR}/LinearMath/btScalar.h")
  file(STRINGS "${Bullet_INCLUDE_DIR}/LinearMath/btScalar.h" number REGEX "define BT_BULLET_VERSION ")
  string(REGEX REPLACE "^.* ([0-9])([0-9]+)$" "\\1.\\2" Bullet_VERSION "${number}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Bullet
  REQUIRED_VARS Bullet_INCLUDE_DIR Bullet_BulletDynamics Bullet_BulletCollision Bullet_LinearMath
  VERSION_VAR Bullet_VERSION)
if(Bullet_FOUND AND NOT TARGET Bullet::Bullet)
  add_library(Bullet::Bullet INTERFACE IMPORTED)
  set_target_properties(Bullet::Bullet PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Bullet_INCLUDE_DIR}" INTERFACE_LINK_LIBRARIES "${Bullet_LIBRARIES}"
    INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION)
endif()
mark_as_advanced(Bullet_INCLUDE_DIR)
