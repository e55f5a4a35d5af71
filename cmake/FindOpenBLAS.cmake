# Finds OpenBLAS by its own name, not by that of the alternative which the system calls its BLAS: target
# OpenBLAS::OpenBLAS. The functions that set its threads are checked for by the link itself.
find_library(OpenBLAS_LIBRARY openblas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenBLAS REQUIRED_VARS OpenBLAS_LIBRARY)
if(OpenBLAS_FOUND AND NOT TARGET OpenBLAS::OpenBLAS)
  add_library(OpenBLAS::OpenBLAS UNKNOWN IMPORTED)
  set_target_properties(OpenBLAS::OpenBLAS PROPERTIES IMPORTED_LOCATION ${OpenBLAS_LIBRARY})
endif()
mark_as_advanced(OpenBLAS_LIBRARY)
