# SPDX-License-Identifier: BSD-3-Clause
# Third-party packages. docs/decisions has the reason of each.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(spdlog REQUIRED)
find_package(Threads REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
if(POLICY CMP0167)
  cmake_policy(SET CMP0167 NEW)  # Boost finds itself
endif()
find_package(Boost 1.74 REQUIRED)  # headers: Boost.Math, Boost.Beast
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)  # inlined
find_package(GDAL REQUIRED)
find_package(TBB REQUIRED)
pkg_check_modules(ODE REQUIRED IMPORTED_TARGET ode)
pkg_check_modules(NETCDF REQUIRED IMPORTED_TARGET netcdf)
pkg_check_modules(SNDFILE REQUIRED IMPORTED_TARGET sndfile)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib)
pkg_check_modules(SLEEF REQUIRED IMPORTED_TARGET sleef)
pkg_check_modules(RE2 REQUIRED IMPORTED_TARGET re2)
# -pthread would define what the common headers were not parsed with; Abseil's, in newer ones, name instructions of a processor.
set_target_properties(PkgConfig::RE2 PROPERTIES INTERFACE_COMPILE_OPTIONS "")

include(cmake/lcm.cmake)
find_program(LCM_GEN lcm-gen REQUIRED)

# The Python package (python) is for Debian's interpreter, whichever the build itself uses.
set(HALOCLINE_PYTHON /usr/bin/python3 CACHE FILEPATH "Interpreter that the Python package is built for")
set(Python_EXECUTABLE ${HALOCLINE_PYTHON})
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
if(Python_FOUND)
  find_package(pybind11 2.10 CONFIG QUIET)
endif()
