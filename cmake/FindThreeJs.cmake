# Finds the script three.js of release 111 with its orbit controls and its licence, as Debian's libjs-three has
# them: target ThreeJs::ThreeJs, and the files in ThreeJs_SCRIPT, ThreeJs_CONTROLS and ThreeJs_NOTICE.
find_file(ThreeJs_SCRIPT NAMES three.min.js three.js PATHS /usr/share/javascript/three PATH_SUFFIXES build)
find_file(ThreeJs_CONTROLS NAMES OrbitControls.js
          PATHS /usr/share/javascript/three/examples/js/controls PATH_SUFFIXES examples/js/controls)
find_file(ThreeJs_NOTICE NAMES copyright LICENSE PATHS /usr/share/doc/libjs-three NO_DEFAULT_PATH)
if(ThreeJs_SCRIPT)
  file(STRINGS "${ThreeJs_SCRIPT}" three_release REGEX "REVISION=\"[0-9]+\"|REVISION = '[0-9]+'" LIMIT_COUNT 1)
  if(three_release MATCHES "REVISION ?= ?[\"']([0-9]+)[\"']")
    set(ThreeJs_VERSION ${CMAKE_MATCH_1})
  endif()
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ThreeJs REQUIRED_VARS ThreeJs_SCRIPT ThreeJs_CONTROLS ThreeJs_NOTICE
                                  VERSION_VAR ThreeJs_VERSION)
if(ThreeJs_FOUND AND NOT TARGET ThreeJs::ThreeJs)
  add_library(ThreeJs::ThreeJs INTERFACE IMPORTED)
endif()
mark_as_advanced(ThreeJs_SCRIPT ThreeJs_CONTROLS ThreeJs_NOTICE)
