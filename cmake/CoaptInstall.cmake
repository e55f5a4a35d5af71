# Install and export by components, each with its own files and licence: core, one per adapter, and the command.
# A component that is not installed is not there for find_package; the others work without it.
include(CMakePackageConfigHelpers)

set(coapt_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/coapt)
set(coapt_pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH coapt_prefix_of_pkgconfig /${coapt_pkgconfig_dir} /)
string(REGEX REPLACE "/$" "" coapt_prefix_of_pkgconfig "${coapt_prefix_of_pkgconfig}")

# What else a consumer must find and link: whatever is private to a static library goes to the final link.
set(coapt_finds_core Eigen3)
set(coapt_requires_core "")
set(coapt_archives "")  # TARGET=FILE, of the archives that a portable build ships beside its own

# coapt_ship(<component> <target>): its archive is installed, and those who link the library by pkg-config link it.
function(coapt_ship component target)
  get_target_property(archive ${target} LOCATION)
  cmake_path(GET archive FILENAME name)
  install(FILES ${archive} DESTINATION ${CMAKE_INSTALL_LIBDIR}/coapt COMPONENT ${component})
  set(coapt_archives ${coapt_archives} ${target}=${name} PARENT_SCOPE)
  set(coapt_libs_${component} "${coapt_libs_${component}} -l:${name}" PARENT_SCOPE)
endfunction()

get_target_property(coapt_type coapt_room_core TYPE)
if(coapt_type STREQUAL "STATIC_LIBRARY" AND COAPT_PORTABLE)
  set(coapt_libs_core "-L\${libdir}/coapt")
  foreach(part IN ITEMS PUGIXML=${COAPT_PUGIXML} ZLIB=ZLIB::ZLIB METIS=METIS::METIS)
    string(REGEX MATCH "^([A-Z]+)=(.+)$" part ${part})
    if(COAPT_HAS_${CMAKE_MATCH_1})
      coapt_ship(core ${CMAKE_MATCH_2})
    endif()
  endforeach()
elseif(coapt_type STREQUAL "STATIC_LIBRARY")
  if(COAPT_HAS_PUGIXML)
    list(APPEND coapt_finds_core pugixml)
    list(APPEND coapt_requires_core pugixml)
  endif()
  if(COAPT_HAS_PUGIXML AND COAPT_HAS_ZLIB)
    list(APPEND coapt_finds_core ZLIB)
    list(APPEND coapt_requires_core zlib)
  endif()
  if(COAPT_HAS_METIS)
    list(APPEND coapt_finds_core METIS)
    set(coapt_libs_core "-lmetis")
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

# coapt_pkg_config(<component> <file name> <description> LIBRARIES <in the order of the linker> REQUIRES <modules>)
function(coapt_pkg_config component name description)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;REQUIRES" ${ARGN})
  string(REPLACE ";" ", " modules "${ARG_REQUIRES}")
  list(TRANSFORM ARG_LIBRARIES PREPEND "-l")
  string(REPLACE ";" " " libraries "${ARG_LIBRARIES}")
  if(NOT name STREQUAL "coapt-shared")
    string(APPEND libraries " ${coapt_libs_${component}}")
  endif()
  string(STRIP "${libraries}" libraries)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/coapt.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${coapt_pkgconfig_dir} COMPONENT ${component})
endfunction()

# coapt_install_libraries(<component> <targets>...)
function(coapt_install_libraries component)
  foreach(target IN LISTS ARGN)
    get_target_property(type ${target} TYPE)
    set(headers FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/coapt COMPONENT ${component})
    if(target STREQUAL "coapt")
      set(headers FILE_SET umbrella DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${component})
    elseif(type STREQUAL "INTERFACE_LIBRARY")
      set(headers "")
    endif()
    install(TARGETS ${target} EXPORT coapt-${component}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
            ${headers})
  endforeach()
  install(EXPORT coapt-${component} NAMESPACE coapt:: FILE coapt-${component}-targets.cmake
          DESTINATION ${coapt_config_dir} COMPONENT ${component})
endfunction()

list(TRANSFORM COAPT_ROOMS PREPEND coapt_room_ OUTPUT_VARIABLE coapt_room_targets)
list(TRANSFORM COAPT_CORE_ROOMS PREPEND coapt_ OUTPUT_VARIABLE coapt_core_libraries)
coapt_pkg_config(core coapt "${PROJECT_DESCRIPTION} (compile as C++20)"
                 LIBRARIES ${coapt_core_libraries} REQUIRES eigen3)
if(COAPT_HAS_JSON)
  coapt_install_libraries(core ${coapt_room_targets} coapt coapt_scene)
  set(libraries ${COAPT_ROOMS})
  list(REMOVE_ITEM libraries ${COAPT_CORE_ROOMS})
  list(TRANSFORM libraries PREPEND coapt_)
  coapt_pkg_config(core coapt-scene "Scene files of Coapt, valves and their results (compile as C++20)"
                   LIBRARIES ${libraries} REQUIRES "coapt = ${PROJECT_VERSION}" ${coapt_requires_core})
else()
  coapt_install_libraries(core ${coapt_room_targets} coapt)
endif()
if(COAPT_SHARED_LIBRARY)
  # What programs load is a component of its own, what they are linked by belongs to the core's.
  install(TARGETS coapt_shared EXPORT coapt-shared
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT shared NAMELINK_COMPONENT core)
  install(EXPORT coapt-shared NAMESPACE coapt:: FILE coapt-shared-targets.cmake
          DESTINATION ${coapt_config_dir} COMPONENT core)
  coapt_pkg_config(core coapt-shared "${PROJECT_DESCRIPTION}, all of it as a shared library (compile as C++20)"
                   LIBRARIES coapt REQUIRES eigen3)
endif()
set(coapt_adapters "")
foreach(adapter IN ITEMS cgal cholmod ceres nlopt)
  if(TARGET coapt_${adapter})
    list(APPEND coapt_adapters ${adapter})
    string(TOUPPER ${adapter} upper)
    coapt_install_libraries(${adapter} coapt_${adapter})
    coapt_pkg_config(${adapter} coapt-${adapter} "Adapter of Coapt: ${COAPT_GIVES_${upper}}"
                     LIBRARIES coapt_${adapter} REQUIRES "coapt = ${PROJECT_VERSION}")
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/coaptConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/coaptConfig.cmake
                              INSTALL_DESTINATION ${coapt_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/coaptConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/coaptConfig.cmake ${PROJECT_BINARY_DIR}/coaptConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake ${PROJECT_SOURCE_DIR}/cmake/FindMETIS.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindOpenBLAS.cmake
        DESTINATION ${coapt_config_dir} COMPONENT core)
if(TARGET coapt_command)
  install(TARGETS coapt_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  get_target_property(coapt_pages coapt_command COAPT_PAGES)
  install(DIRECTORY ${coapt_pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command
          FILES_MATCHING PATTERN "*.1")
  install(FILES ${coapt_pages}/coapt.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME coapt COMPONENT command)
  install(FILES ${coapt_pages}/_coapt DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT command)
  install(FILES ${PROJECT_SOURCE_DIR}/schema/scene.schema.json ${PROJECT_SOURCE_DIR}/schema/result.schema.json
          DESTINATION ${CMAKE_INSTALL_DATADIR}/coapt/schema COMPONENT command)
endif()
if(COAPT_PORTABLE)
  include(CoaptTarball)
elseif(coapt_type STREQUAL "STATIC_LIBRARY")
  include(CoaptDebian)
endif()
