# The one shared library of all rooms that are installed, libcoapt.so, made of the archives of the rooms: nothing is compiled
# twice. It shows the names of coapt alone: Eigen, JSON and the standard library are compiled into it and into those who use
# it, each by flags of its own, and may not take the place of one another.
set(coapt_archive_targets ${COAPT_ROOMS})
list(TRANSFORM coapt_archive_targets PREPEND coapt_room_)
file(CONFIGURE OUTPUT shared_library.cpp CONTENT "// All of it is in the archives.\n")
add_library(coapt_shared SHARED ${PROJECT_BINARY_DIR}/shared_library.cpp)
set_target_properties(coapt_shared PROPERTIES OUTPUT_NAME coapt EXPORT_NAME shared VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                      LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exported_names.map)
if(COAPT_PORTABLE)
  # Its users bring the runtime of C++ along; two of them in one program would not know each other's exceptions.
  set_target_properties(coapt_shared PROPERTIES LINK_OPTIONS "-s")
endif()
target_compile_features(coapt_shared PUBLIC cxx_std_20)
target_include_directories(coapt_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/coapt>
                                                  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(coapt_shared PUBLIC Eigen3::Eigen)
# A program that linked the archives as well would have everything twice; CMake refuses it.
foreach(target IN ITEMS coapt_shared coapt_room_core)
  set_property(TARGET ${target} APPEND PROPERTY COMPATIBLE_INTERFACE_STRING COAPT_LIBRARY)
endforeach()
set_property(TARGET coapt_shared PROPERTY INTERFACE_COAPT_LIBRARY "shared")
set_property(TARGET coapt_room_core PROPERTY INTERFACE_COAPT_LIBRARY "archives")
list(JOIN coapt_archive_targets "," whole)
set_target_properties(coapt_shared PROPERTIES LINK_LIBRARY_OVERRIDE "WHOLE_ARCHIVE,${whole}")
target_link_libraries(coapt_shared PRIVATE ${coapt_archive_targets})
target_link_options(coapt_shared PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/exported_names.map
                    LINKER:-Bsymbolic-functions LINKER:--no-undefined)
