# What every library of ours shares: language level, warnings (never exported), header file set.

function(coapt_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  # GCC 12 warns wrongly of its own strings (bugs 105329 and 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow)
  endif()
  if(COAPT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# coapt_library(<target> EXPORT_AS <name>): installed and exported as coapt::<name>.
function(coapt_library target)
  cmake_parse_arguments(ARG "" "EXPORT_AS" "" ${ARGN})
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${ARG_EXPORT_AS}
                                             POSITION_INDEPENDENT_CODE ON
                                             VERSION ${PROJECT_VERSION}
                                             SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src)
  coapt_warnings(${target})
endfunction()

# coapt_sources(<target> HEADERS <files> SOURCES <files>): files of one folder; the headers are installed. With
# COAPT_UNITY_BUILD sixteen sources of the list, in its order, are one translation unit, and eight in the rooms where a
# touched file must be built quickly; a source with flags of its own stays one by itself.
function(coapt_sources target)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES" ${ARGN})
  list(TRANSFORM ARG_HEADERS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(TRANSFORM ARG_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(${target} PRIVATE ${ARG_SOURCES}
                           PUBLIC FILE_SET HEADERS FILES ${ARG_HEADERS})
  if(COAPT_UNITY_BUILD)
    if(target MATCHES "_(mesh|energy|linear|optim|sensitivity|valve|stress|study)$")
      coapt_unite(${target} 8 ${ARG_SOURCES})
    else()
      coapt_unite(${target} 16 ${ARG_SOURCES})
    endif()
  endif()
endfunction()

# coapt_room(<room> DEPENDS <rooms> HEADERS <files> SOURCES <files>): the library coapt_room_<room> of src/<room>, or
# more files of it. It links the rooms that it depends on, and those that they depend on.
function(coapt_room room)
  cmake_parse_arguments(ARG "" "" "DEPENDS;HEADERS;SOURCES" ${ARGN})
  set(target coapt_room_${room})
  if(NOT TARGET ${target})
    add_library(${target})
    add_library(coapt::room_${room} ALIAS ${target})
    coapt_library(${target} EXPORT_AS room_${room})
    set_target_properties(${target} PROPERTIES OUTPUT_NAME coapt_${room})
    target_link_libraries(${target} PUBLIC Eigen3::Eigen)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    if(room IN_LIST COAPT_CORE_ROOMS OR room STREQUAL "xpbd" OR room STREQUAL "valve")
      coapt_reuse_headers(${target} coapt_headers)
    else()
      if(COAPT_HAS_JSON)
        target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
      endif()
      coapt_reuse_headers(${target} coapt_scene_headers)
    endif()
  endif()
  list(TRANSFORM ARG_DEPENDS PREPEND coapt_room_)
  target_link_libraries(${target} PUBLIC ${ARG_DEPENDS})
  coapt_sources(${target} HEADERS ${ARG_HEADERS} SOURCES ${ARG_SOURCES})
endfunction()

# coapt_umbrella(<target>): the headers <coapt/coapt.hpp> and <coapt/version.hpp>, which belong to no room.
function(coapt_umbrella target)
  set(written ${PROJECT_BINARY_DIR}/include)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/version.hpp.in ${written}/coapt/version.hpp @ONLY)
  target_sources(${target} INTERFACE FILE_SET umbrella TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include ${written}
                 FILES ${PROJECT_SOURCE_DIR}/include/coapt/coapt.hpp ${written}/coapt/version.hpp)
endfunction()

# coapt_unite(<target> <size> <sources>): groups of so many, named after the folder and the first source.
function(coapt_unite target size)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME room)
  set(count 0)
  foreach(source IN LISTS ARGN)
    math(EXPR place "${count} % ${size}")
    if(place EQUAL 0)
      cmake_path(GET source STEM first)
      set(group ${room}_${first})
    endif()
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group})
    math(EXPR count "${count} + 1")
  endforeach()
endfunction()

# coapt_link_adapters(<target> [ONLY <names>]): every adapter of the build, or these of them, said to the sources of src/cli
# by COAPT_HAS_<NAME>.
function(coapt_link_adapters target)
  cmake_parse_arguments(ARG "" "" "ONLY" ${ARGN})
  foreach(adapter IN ITEMS cgal cholmod ceres nlopt)
    if(TARGET coapt_${adapter} AND (NOT ARG_ONLY OR adapter IN_LIST ARG_ONLY))
      string(TOUPPER ${adapter} name)
      target_link_libraries(${target} PRIVATE coapt_${adapter})
      target_compile_definitions(${target} PRIVATE COAPT_HAS_${name})
      set_property(TARGET ${target} PROPERTY COAPT_USES_${name} ON)
    endif()
  endforeach()
endfunction()

# coapt_precompiled_headers(<name> <headers>): third-party headers, parsed once for all rooms that reuse them, where the
# build asks for it. Never for includes to rely on; the preset `separate` builds without.
function(coapt_precompiled_headers name)
  if(COAPT_PRECOMPILED_HEADERS)
    file(CONFIGURE OUTPUT ${name}.cpp CONTENT "")
    add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    target_compile_features(${name} PUBLIC cxx_std_20)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(${name} PRIVATE Eigen3::Eigen)
    coapt_warnings(${name})
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
endfunction()

function(coapt_reuse_headers target from)
  if(COAPT_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()

function(coapt_precompile target)
  if(COAPT_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Target docs: the site in docs/html of the build tree, by the same script as without CMake.
function(coapt_docs_target)
  find_program(COAPT_DOXYGEN doxygen)
  if(COAPT_DOXYGEN)
    add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E env COAPT_DOCS_INSTALLED=yes
                           ${PROJECT_SOURCE_DIR}/scripts/docs ${PROJECT_BINARY_DIR}/docs
                      USES_TERMINAL VERBATIM)
  endif()
endfunction()
