# Finds the parts of the Insight Toolkit that read, write and filter volumes: target ITKImage::ITKImage. Only these modules,
# as others would bring VTK with them.
if(CMAKE_C_COMPILER)  # the search for HDF5, on which ITK's configuration insists, compiles a C program
  set(coapt_message_level ${CMAKE_MESSAGE_LOG_LEVEL})
  set(CMAKE_MESSAGE_LOG_LEVEL ERROR)  # GDCM's configuration names files of packages that nothing here needs
  find_package(ITK 5.2 QUIET CONFIG COMPONENTS ITKCommon ITKImageFeature ITKImageGrid ITKSmoothing ITKThresholding
               ITKConnectedComponents ITKDistanceMap ITKMathematicalMorphology ITKFastMarching ITKIOImageBase ITKIONRRD ITKIONIFTI
               ITKIOMeta ITKIOGDCM)
  set(CMAKE_MESSAGE_LOG_LEVEL ${coapt_message_level})
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ITKImage REQUIRED_VARS ITK_LIBRARIES ITK_INCLUDE_DIRS VERSION_VAR ITK_VERSION)
if(ITKImage_FOUND AND NOT TARGET ITKImage::ITKImage)
  add_library(ITKImage::ITKImage INTERFACE IMPORTED)
  target_include_directories(ITKImage::ITKImage SYSTEM INTERFACE ${ITK_INCLUDE_DIRS})
  target_link_libraries(ITKImage::ITKImage INTERFACE ${ITK_LIBRARIES})
endif()
