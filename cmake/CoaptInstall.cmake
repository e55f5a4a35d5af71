# Install and export by components, each with its own files and licence: core, one per adapter, and the command.
# A component that is not installed is not there for find_package; the others work without it.
include(CMakePackageConfigHelpers)

set(coapt_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/coapt)
set(coapt_pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH coapt_prefix_of_pkgconfig /${coapt_pkgconfig_dir} /)
string(REGEX REPLACE "/$" "" coapt_prefix_of_pkgconfig "${coapt_prefix_of_pkgconfig}")

# What else a consumer must find and link: whatever is private to a static library goes to the final link.
set(coapt_finds_core Eigen3)
set(coapt_requires_core eigen3)
get_target_property(coapt_type coapt TYPE)
if(coapt_type STREQUAL "STATIC_LIBRARY")
  if(COAPT_HAS_PUGIXML)
    list(APPEND coapt_finds_core pugixml)
    list(APPEND coapt_requires_core pugixml)
  endif()
  if(COAPT_HAS_PUGIXML AND COAPT_HAS_ZLIB)
    list(APPEND coapt_finds_core ZLIB)
    list(APPEND coapt_requires_core zlib)
  endif()
  set(coapt_finds_cgal CGAL)
  set(coapt_libs_cgal "-lmpfr -lgmp")
  # OpenBLAS before CHOLMOD, see src/optim/cholmod.
  set(coapt_finds_cholmod OpenBLAS CHOLMOD)
  set(coapt_libs_cholmod "-lopenblas -lcholmod -ldl")
  set(coapt_finds_ceres Ceres)
  set(coapt_libs_ceres "-lceres -lglog")
  set(coapt_finds_nlopt NLopt)
  set(coapt_libs_nlopt "-lnlopt")
endif()

# coapt_install_library(<component> <target> <pkg-config name> <description> <modules it requires>...)
function(coapt_install_library component target name description)
  install(TARGETS ${target} EXPORT coapt-${component}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/coapt COMPONENT ${component})
  install(EXPORT coapt-${component} NAMESPACE coapt:: FILE coapt-${component}-targets.cmake
          DESTINATION ${coapt_config_dir} COMPONENT ${component})
  string(REPLACE ";" ", " modules "${ARGN}")
  string(STRIP "-l${target} ${coapt_libs_${component}}" libraries)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/coapt.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${coapt_pkgconfig_dir} COMPONENT ${component})
endfunction()

coapt_install_library(core coapt coapt "${PROJECT_DESCRIPTION} (compile as C++20)" ${coapt_requires_core})
set(coapt_adapters "")
foreach(adapter IN ITEMS cgal cholmod ceres nlopt)
  if(TARGET coapt_${adapter})
    list(APPEND coapt_adapters ${adapter})
    string(TOUPPER ${adapter} upper)
    coapt_install_library(${adapter} coapt_${adapter} coapt-${adapter}
                          "Adapter of Coapt: ${COAPT_GIVES_${upper}}" "coapt = ${PROJECT_VERSION}")
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/coaptConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/coaptConfig.cmake
                              INSTALL_DESTINATION ${coapt_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/coaptConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/coaptConfig.cmake ${PROJECT_BINARY_DIR}/coaptConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake ${PROJECT_SOURCE_DIR}/cmake/FindOpenBLAS.cmake
        DESTINATION ${coapt_config_dir} COMPONENT core)
if(TARGET coapt_command)
  install(TARGETS coapt_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(FILES ${PROJECT_SOURCE_DIR}/schema/scene.schema.json ${PROJECT_SOURCE_DIR}/schema/result.schema.json
          DESTINATION ${CMAKE_INSTALL_DATADIR}/coapt/schema COMPONENT command)
endif()
if(coapt_type STREQUAL "STATIC_LIBRARY")
  include(CoaptDebian)  # a shared library would want a package of its own beside the one for development
endif()
