# Debian packages `parallax`, `libparallax0.2`, `libparallax-dev` and `python3-parallax`, made by tools/package and
# described in docs/guide/installing.md.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME parallax)
set(CPACK_PACKAGE_VENDOR "The parallax authors")
# The project has no address of its own: whoever distributes packages sets one.
set(no_contact "The parallax authors <parallax@localhost>")
set(PARALLAX_PACKAGE_CONTACT "${no_contact}" CACHE STRING "Maintainer of packages, NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT "${PARALLAX_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program shared development python)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME parallax)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# git is for `bisect` and histories, python3 for simulators in Python.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "git, python3")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"finds where a formal model of a robot's environment and physics part
Compiles Discrete Event Calculus models and robot plans to SAT, enumerates
the traces that reach interesting states, replays each of them in a physics
simulator from sampled start states, and reports the first place where
prediction and physics disagree, or what can be claimed when they do not.")

set(PARALLAX_SHARED_PACKAGE libparallax${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_SHARED_PACKAGE_NAME ${PARALLAX_SHARED_PACKAGE})
set(CPACK_DEBIAN_SHARED_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_SHARED_PACKAGE_SHLIBDEPS ON)
# Its ldconfig is run by dpkg's trigger; `shlibs` tells dpkg-shlibdeps which package a client needs.
set(control ${PROJECT_BINARY_DIR}/generated/packages)
set(CPACK_DEBIAN_SHARED_PACKAGE_CONTROL_EXTRA ${control}/triggers ${control}/shlibs)
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
file(WRITE ${control}/shlibs "libparallax ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} \
${PARALLAX_SHARED_PACKAGE} (>= ${PROJECT_VERSION})\n")
# The program simulates built-in worlds for it.
set(CPACK_DEBIAN_SHARED_PACKAGE_RECOMMENDS "parallax (= ${PROJECT_VERSION}-1)")
set(CPACK_COMPONENT_SHARED_DESCRIPTION
"library of parallax, shared
Models, their traces and the loop that holds them against simulations, behind
one small interface. Programs that use it are built with libparallax-dev.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libparallax-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# The packages that parallaxConfig.cmake looks for; scenarios with SDF need the module of the program.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "${PARALLAX_SHARED_PACKAGE} (= ${PROJECT_VERSION}-1), libcadical-dev, libeigen3-dev, libfmt-dev, libgmp-dev, libode-dev, libyaml-cpp-dev, nlohmann-json3-dev")
if("PARALLAX_HAS_URDFDOM" IN_LIST readers)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", liburdfdom-dev")
endif()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "parallax (= ${PROJECT_VERSION}-1)")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"libraries of parallax, to be linked from C++
Headers and static libraries of parallax, with files for CMake and pkg-config:
compile models, enumerate traces, simulate worlds and judge predictions.
.
Programs that are linked with them need C++20.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-parallax)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "parallax (>= ${PROJECT_VERSION}), python3 (>= 3.8)")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, jupyter-notebook")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"Python package for parallax, for programs and notebooks
Traces, counts, properties, runs in a simulator and rates of discrepancies as
dataclasses, streams and pictures, and a decorator that makes a simulator of
a Python class. Needs nothing but Python and the program.")

# Two changelogs: what is new for users, and the one that Debian requires of packages.
set(made ${PROJECT_BINARY_DIR}/generated/packages)
file(CONFIGURE OUTPUT ${made}/changelog.Debian @ONLY CONTENT
"parallax (@PROJECT_VERSION@-1) unstable; urgency=medium

  * Version @PROJECT_VERSION@; changelog.gz says what is new.

 -- @PARALLAX_PACKAGE_CONTACT@  @PARALLAX_DEBIAN_DATE@
")
foreach(package parallax libparallax-dev ${PARALLAX_SHARED_PACKAGE} python3-parallax)
  if(package STREQUAL parallax)
    set(component program)
  elseif(package STREQUAL PARALLAX_SHARED_PACKAGE)
    set(component shared)
    install(FILES ${PROJECT_BINARY_DIR}/generated/copyright
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
  elseif(package STREQUAL python3-parallax)
    set(component python)
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
  else()
    set(component development)
    install(FILES ${PROJECT_BINARY_DIR}/generated/copyright
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
    # What the library's headers are for, and the program that shows it.
    install(FILES ${PROJECT_SOURCE_DIR}/docs/guide/library/README.md RENAME library.md
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/guide/library/
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}/examples COMPONENT ${component})
  endif()
  install(CODE "
    set(folder \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/${package}\")
    file(INSTALL DESTINATION \"\${folder}\" TYPE FILE FILES \"${made}/changelog.Debian\")
    file(INSTALL DESTINATION \"\${folder}\" TYPE FILE RENAME changelog
      FILES \"${PROJECT_SOURCE_DIR}/CHANGELOG.md\")
    execute_process(COMMAND gzip -9nf \"\$ENV{DESTDIR}\${folder}/changelog.Debian\"
      \"\$ENV{DESTDIR}\${folder}/changelog\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
  set(overrides
    "# These packages are no part of Debian, where a first version answers a request.\n${package}: initial-upload-closes-no-bugs *\n")
  if(PARALLAX_PACKAGE_CONTACT STREQUAL no_contact)
    string(APPEND overrides
      "# The project has no address of its own.\n${package}: bogus-mail-host *\n${package}: bogus-mail-host-in-debian-changelog *\n")
  endif()
  file(CONFIGURE OUTPUT ${made}/overrides/${package} @ONLY CONTENT "${overrides}")
  install(FILES ${made}/overrides/${package}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
endforeach()

include(CPack)
