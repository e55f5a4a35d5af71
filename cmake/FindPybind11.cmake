# Finds pybind11 and the Python that the module is made for: target pybind11::module. The PATH may begin with another
# Python than the system's, one without NumPy, so the system's is taken unless Python_EXECUTABLE says otherwise.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that the module is made for")
endif()
find_package(Python 3.10 QUIET COMPONENTS Interpreter Development.Module)
if(Python_FOUND)  # pybind11 ends the configuration where it finds none
  set(PYBIND11_FINDPYTHON ON)
  find_package(pybind11 2.10 CONFIG QUIET)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Pybind11 REQUIRED_VARS pybind11_DIR VERSION_VAR pybind11_VERSION)
