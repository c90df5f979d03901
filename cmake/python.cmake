# Python and pybind11 for the module `cloud2csg`, when CLOUD2CSG_PYTHON wants it and they are there. Sets
# CLOUD2CSG_HAS_PYTHON.
set(CLOUD2CSG_HAS_PYTHON OFF)
if(NOT CLOUD2CSG_PYTHON MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "CLOUD2CSG_PYTHON is AUTO, ON or OFF, not '${CLOUD2CSG_PYTHON}'")
endif()
if(CLOUD2CSG_PYTHON STREQUAL "OFF")
  return()
endif()
# A module built with sanitizers loads into an interpreter built without only by tricks with the loader.
if(CLOUD2CSG_SANITIZERS)
  if(CLOUD2CSG_PYTHON STREQUAL "ON")
    message(FATAL_ERROR "CLOUD2CSG_PYTHON and CLOUD2CSG_SANITIZERS do not go together")
  endif()
  message(STATUS "sanitizers are on: no Python module")
  return()
endif()

# The system's own interpreter, whatever else comes first in PATH: its NumPy is the one that the packages install. A
# build of a wheel, or the user, may name another.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(Python 3.11 COMPONENTS Interpreter Development.Module NumPy)
if(Python_FOUND)
  find_package(pybind11 2.10 CONFIG)
endif()
if(Python_FOUND AND pybind11_FOUND)
  set(CLOUD2CSG_HAS_PYTHON ON)
elseif(CLOUD2CSG_PYTHON STREQUAL "ON")
  message(FATAL_ERROR "the Python module needs python3-dev, python3-numpy and pybind11-dev")
else()
  message(STATUS "Python with NumPy, or pybind11, is not found: no Python module "
                 "(install python3-dev, python3-numpy, pybind11-dev)")
endif()
