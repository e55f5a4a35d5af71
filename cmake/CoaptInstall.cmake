# Install and export, so that find_package(coapt) works for a consumer.
include(CMakePackageConfigHelpers)

set(coapt_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/coapt)

foreach(target IN ITEMS coapt coapt_cgal coapt_cholmod coapt_ceres coapt_nlopt)
  if(TARGET ${target})
    install(TARGETS ${target} EXPORT coaptTargets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
            FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/coapt)
  endif()
endforeach()
if(TARGET coapt_command)
  install(TARGETS coapt_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

install(EXPORT coaptTargets NAMESPACE coapt:: DESTINATION ${coapt_config_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/coaptConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/coaptConfig.cmake
                              INSTALL_DESTINATION ${coapt_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/coaptConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/coaptConfig.cmake ${PROJECT_BINARY_DIR}/coaptConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake ${PROJECT_SOURCE_DIR}/cmake/FindOpenBLAS.cmake
        DESTINATION ${coapt_config_dir})
