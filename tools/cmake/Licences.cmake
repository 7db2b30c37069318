# Parts of the program and their licences: an SPDX document, and the notices of the code that the program
# contains. Included after all libraries have been looked for.
#
# parallax_part(NAME DEBIAN_PACKAGE LICENCE HOW VERSION): HOW is CONTAINS (in the program's own bytes),
# DYNAMIC_LINK (needed to start) or RUNTIME (loaded by a module, when it is needed). Libraries that others
# bring along are parts too.
set(PARALLAX_SPDX_PACKAGES "")
set(PARALLAX_SPDX_RELATIONS "")
set(PARALLAX_NOTICES "")
function(parallax_part name package licence how version)
  # For Debian's packages, source package and version as Debian names them.
  execute_process(COMMAND dpkg-query -W -f=\${source:Package}@\${source:Version} ${package}
    OUTPUT_VARIABLE source RESULT_VARIABLE code ERROR_QUIET)
  set(reference "")
  if(code EQUAL 0)
    string(REGEX MATCH "[^@]*$" version "${source}")
    string(REPLACE ":" "%3A" source "${source}")
    string(REPLACE "+" "%2B" source "${source}")
    set(reference ",\n      \"externalRefs\": [{\"referenceCategory\": \"PACKAGE-MANAGER\", \"referenceType\": \"purl\", \"referenceLocator\": \"pkg:deb/debian/${source}?arch=source\"}]")
  endif()
  if(version STREQUAL "")
    set(version NOASSERTION)
  endif()
  string(REGEX REPLACE "[^A-Za-z0-9.-]" "-" id "SPDXRef-${name}")
  string(APPEND PARALLAX_SPDX_PACKAGES ",
    {
      \"name\": \"${name}\",
      \"SPDXID\": \"${id}\",
      \"versionInfo\": \"${version}\",
      \"downloadLocation\": \"NOASSERTION\",
      \"filesAnalyzed\": false,
      \"licenseConcluded\": \"${licence}\",
      \"licenseDeclared\": \"${licence}\",
      \"copyrightText\": \"NOASSERTION\"${reference}
    }")
  set(relation ${how})
  if(how STREQUAL RUNTIME)
    set(relation DYNAMIC_LINK)
  endif()
  string(APPEND PARALLAX_SPDX_RELATIONS ",
    {\"spdxElementId\": \"SPDXRef-parallax\", \"relationshipType\": \"${relation}\", \"relatedSpdxElement\": \"${id}\"}")
  set(PARALLAX_SPDX_PACKAGES "${PARALLAX_SPDX_PACKAGES}" PARENT_SCOPE)
  set(PARALLAX_SPDX_RELATIONS "${PARALLAX_SPDX_RELATIONS}" PARENT_SCOPE)
  # Licences of contained code require that their texts come along.
  set(notice /usr/share/doc/${package}/copyright)
  if(how STREQUAL CONTAINS AND EXISTS ${notice})
    file(READ ${notice} text)
    string(APPEND PARALLAX_NOTICES "\n\n-- ${name} ${version} --\n\n${text}")
    set(PARALLAX_NOTICES "${PARALLAX_NOTICES}" PARENT_SCOPE)
  endif()
endfunction()

parallax_part(CaDiCaL libcadical-dev MIT CONTAINS "${Cadical_VERSION}")
parallax_part(CLI11 libcli11-dev BSD-3-Clause CONTAINS "${CLI11_VERSION}")
parallax_part(nlohmann-json nlohmann-json3-dev MIT CONTAINS "${nlohmann_json_VERSION}")
parallax_part(Eigen libeigen3-dev MPL-2.0 CONTAINS "${Eigen3_VERSION}")
parallax_part(three.js libjs-three MIT CONTAINS "")
# Shared libraries with code in their headers.
parallax_part(fmt libfmt-dev MIT CONTAINS "${fmt_VERSION}")
parallax_part(yaml-cpp libyaml-cpp-dev MIT CONTAINS "${yaml-cpp_VERSION}")
parallax_part(GMP libgmp-dev "LGPL-3.0-or-later OR GPL-2.0-or-later" DYNAMIC_LINK "${Gmp_VERSION}")
parallax_part(ODE libode-dev "LGPL-2.1-or-later OR BSD-3-Clause" DYNAMIC_LINK "${Ode_VERSION}")
parallax_part(libccd libccd2 BSD-3-Clause DYNAMIC_LINK "")
get_target_property(readers parallax_world COMPILE_DEFINITIONS)
if("PARALLAX_HAS_URDFDOM" IN_LIST readers)
  parallax_part(urdfdom liburdfdom-dev BSD-3-Clause DYNAMIC_LINK "")
  parallax_part(urdfdom_headers liburdfdom-headers-dev BSD-3-Clause CONTAINS "")
  parallax_part(console_bridge libconsole-bridge-dev BSD-3-Clause DYNAMIC_LINK "")
  parallax_part(TinyXML libtinyxml2.6.2v5 Zlib DYNAMIC_LINK "")
endif()
if(TARGET parallax_sdf)
  parallax_part(libsdformat libsdformat-dev Apache-2.0 RUNTIME "")
  parallax_part(ignition-math libignition-math-dev Apache-2.0 RUNTIME "")
endif()
if(TARGET parallax_mesh)
  parallax_part(Assimp libassimp-dev BSD-3-Clause RUNTIME "")
  parallax_part(Qhull libqhull-dev Qhull RUNTIME "")
  parallax_part(zlib zlib1g Zlib RUNTIME "")
  parallax_part(minizip libminizip1 Zlib RUNTIME "")
  parallax_part(Draco libdraco7 Apache-2.0 RUNTIME "")
endif()
if(TARGET parallax_mujoco)
  parallax_part(MuJoCo libmujoco-dev Apache-2.0 RUNTIME "")
  parallax_part(LodePNG liblodepng0 Zlib RUNTIME "")
endif()
if(TARGET parallax_bullet)
  parallax_part(Bullet libbullet-dev Zlib RUNTIME "")
endif()
if(TARGET parallax_sdf OR TARGET parallax_mujoco)
  parallax_part(TinyXML-2 libtinyxml2-9 Zlib RUNTIME "")
endif()
parallax_part("GNU C Library" libc6-dev LGPL-2.1-or-later DYNAMIC_LINK "")
parallax_part(libstdc++ libstdc++6 "GPL-3.0-or-later WITH GCC-exception-3.1" DYNAMIC_LINK
  "${CMAKE_CXX_COMPILER_VERSION}")

string(UUID PARALLAX_SPDX_ID NAMESPACE 6ba7b810-9dad-11d1-80b4-00c04fd430c8 TYPE SHA1
  NAME "parallax-${PROJECT_VERSION}${PARALLAX_SPDX_PACKAGES}")
configure_file(${PROJECT_SOURCE_DIR}/tools/cmake/parallax.spdx.json.in
  ${PROJECT_BINARY_DIR}/generated/parallax.spdx.json @ONLY)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/copyright @ONLY CONTENT
"parallax ${PROJECT_VERSION}

${licence}

The program carries code of the libraries below within it. Their notices follow as Debian keeps them;
they speak of whole source packages, of which only the libraries themselves are in the program. What
it links besides, and under which licences, stands in
/usr/share/parallax/parallax.spdx.json.@PARALLAX_NOTICES@")
install(FILES ${PROJECT_BINARY_DIR}/generated/parallax.spdx.json
  DESTINATION ${CMAKE_INSTALL_DATADIR}/parallax COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/generated/copyright
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/parallax COMPONENT program)
