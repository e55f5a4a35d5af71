# Finds the parts of the Insight Toolkit that read, write and filter volumes: target ITKImage::ITKImage. Only these modules,
# as others would bring VTK with them.
if(CMAKE_C_COMPILER)  # the search for HDF5, on which ITK's configuration insists, compiles a C program
  set(coapt_message_level ${CMAKE_MESSAGE_LOG_LEVEL})
  set(CMAKE_MESSAGE_LOG_LEVEL ERROR)  # GDCM's configuration names files of packages that nothing here needs
  find_package(ITK 5.2 QUIET CONFIG COMPONENTS ITKCommon ITKImageFeature ITKImageGrid ITKSmoothing ITKThresholding
               ITKConnectedComponents ITKDistanceMap ITKMathematicalMorphology ITKFastMarching ITKIOImageBase ITKIONRRD ITKIONIFTI
               ITKIOMeta ITKIOGDCM ITKIOPNG)
  set(CMAKE_MESSAGE_LOG_LEVEL ${coapt_message_level})
endif()
# A build of ITK knows the compilers that it was configured for and refuses others: Debian's takes GCC and no Clang.
if(ITK_INCLUDE_DIRS)
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_INCLUDES ${ITK_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_QUIET ON)
  check_cxx_source_compiles("#include <itkConfigure.h>
int main() { return 0; }" COAPT_ITK_TAKES_COMPILER)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_QUIET)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ITKImage REQUIRED_VARS ITK_LIBRARIES ITK_INCLUDE_DIRS COAPT_ITK_TAKES_COMPILER
                                  VERSION_VAR ITK_VERSION)
if(ITKImage_FOUND AND NOT TARGET ITKImage::ITKImage)
  add_library(ITKImage::ITKImage INTERFACE IMPORTED)
  target_include_directories(ITKImage::ITKImage SYSTEM INTERFACE ${ITK_INCLUDE_DIRS})
  target_link_libraries(ITKImage::ITKImage INTERFACE ${ITK_LIBRARIES})
endif()
