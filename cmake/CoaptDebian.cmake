# Debian packages by CPack, from what the build tree holds: `cpack -G DEB --config BUILD/CPackConfig.cmake`.
# Parts under GPL or LGPL are packages apart; every package says its licence in usr/share/doc/PACKAGE/copyright.

# coapt_debian_package(<component> <package> <section> <summary> LICENCE <SPDX> [DEPENDS <packages>]
#                      [LINKED <NAMES>])
# LINKED: components of the build (CoaptComponents.cmake) that are compiled in or linked to.
function(coapt_debian_package component package section summary)
  cmake_parse_arguments(ARG "" "LICENCE" "DEPENDS;LINKED" ${ARGN})
  set(linked "")
  foreach(name IN LISTS ARG_LINKED)
    if(COAPT_HAS_${name})
      string(APPEND linked "  - ${COAPT_PACKAGE_${name}} (${COAPT_LICENCE_${name}}): ${COAPT_GIVES_${name}}\n")
    endif()
  endforeach()
  file(READ ${PROJECT_SOURCE_DIR}/LICENSE text)
  string(REGEX REPLACE "\n$" "" text "${text}")
  string(REPLACE "\n\n" "\n.\n" text "${text}")
  string(REPLACE "\n" "\n " text "${text}")
  set(COAPT_COPYRIGHT_LICENCE "${ARG_LICENCE}")
  set(COAPT_COPYRIGHT_LINKED "${linked}")
  set(COAPT_COPYRIGHT_TEXT "${text}")
  set(folder ${PROJECT_BINARY_DIR}/debian/${package})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/copyright.in ${folder}/copyright @ONLY)
  install(FILES ${folder}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})

  string(REPLACE ";" ", " depends "${ARG_DEPENDS}")
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION
      "${summary}.\nLicence of this package: ${ARG_LICENCE}." PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
endfunction()

set(CPACK_COMPONENTS_ALL "")
set(coapt_of_same_version "libcoapt-dev (= ${PROJECT_VERSION})")

set(coapt_core_depends "libeigen3-dev (>= 3.4)")
if("pugixml" IN_LIST coapt_finds_core)
  list(APPEND coapt_core_depends libpugixml-dev)
endif()
if("ZLIB" IN_LIST coapt_finds_core)
  list(APPEND coapt_core_depends zlib1g-dev)
endif()
if("METIS" IN_LIST coapt_finds_core)
  list(APPEND coapt_core_depends libmetis-dev)
endif()
if(COAPT_SHARED_LIBRARY)
  set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  list(APPEND coapt_core_depends "libcoapt${soversion} (= ${PROJECT_VERSION})")
  coapt_debian_package(shared libcoapt${soversion} libs "The library as programs load it, without adapters"
                       LICENCE "BSD-3-Clause" LINKED NANOFLANN JSON PUGIXML ZLIB REPORT UPLOT SPECTRA METIS)
  set(CPACK_DEBIAN_SHARED_PACKAGE_SHLIBDEPS ON)
  # CPack adds the scripts that call ldconfig.
  file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs "libcoapt ${soversion} libcoapt${soversion} (>= ${PROJECT_VERSION})\n")
  set(CPACK_DEBIAN_SHARED_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/shlibs)
endif()
coapt_debian_package(core libcoapt-dev libdevel "The library with its headers, for CMake and pkg-config"
                     LICENCE "BSD-3-Clause" DEPENDS ${coapt_core_depends}
                     LINKED NANOFLANN JSON PUGIXML ZLIB REPORT UPLOT SPECTRA METIS)

set(coapt_depends_cgal libcgal-dev)
set(coapt_depends_cholmod libsuitesparse-dev libopenblas-dev)
set(coapt_depends_ceres libceres-dev)
set(coapt_depends_nlopt libnlopt-cxx-dev libnlopt-dev)
foreach(adapter IN LISTS coapt_adapters)
  string(TOUPPER ${adapter} upper)
  set(coapt_adapter_licence "${COAPT_LICENCE_${upper}} as a whole (own code BSD-3-Clause)")
  if(COAPT_LICENCE_${upper} MATCHES "^LGPL")
    set(coapt_adapter_licence "BSD-3-Clause (with ${COAPT_LICENCE_${upper}} parts)")
  endif()
  coapt_debian_package(${adapter} libcoapt-${adapter}-dev libdevel
                       "Adapter to ${COAPT_PACKAGE_${upper}} (${COAPT_GIVES_${upper}}), to be linked beside libcoapt-dev"
                       LICENCE "${coapt_adapter_licence}"
                       DEPENDS ${coapt_of_same_version} ${coapt_depends_${adapter}} LINKED ${upper})
endforeach()

set(coapt_command_parts ${COAPT_COMPONENTS})
list(REMOVE_ITEM coapt_command_parts PYTHON)
if(TARGET coapt_command)
  coapt_combined_licence(coapt_command_licence)
  coapt_debian_package(command coapt science "The command coapt with every component of its build, and the JSON schemas of scene and result"
                       LICENCE "${coapt_command_licence}" LINKED ${coapt_command_parts})
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
endif()

if(TARGET coapt_python)
  find_package(Python QUIET COMPONENTS Interpreter)
  coapt_combined_licence(coapt_python_licence)
  set(coapt_python_parts ${COAPT_COMPONENTS})
  list(REMOVE_ITEM coapt_python_parts CLI11)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  coapt_debian_package(python python3-coapt python "The Python module coapt with every component of its build"
                       LICENCE "${coapt_python_licence}" LINKED ${coapt_python_parts}
                       DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})"
                               "python3 (<< ${Python_VERSION_MAJOR}.${next_minor})" python3-numpy)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-meshio, python3-sympy, python3-tqdm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
endif()

set(CPACK_PACKAGE_NAME coapt)
set(CPACK_PACKAGE_VENDOR "The Coapt authors")
set(CPACK_PACKAGE_CONTACT "The Coapt authors <coapt@example.invalid>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
