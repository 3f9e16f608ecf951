# SPDX-License-Identifier: BSD-3-Clause
# Debian packages: `cpack` in the build folder, or scripts/package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "Halocline developers <halocline@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR})
set(CPACK_COMPONENTS_ALL programs development)
if(TARGET halocline_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME halocline)
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
  "Simulates missions of several autonomous underwater vehicles that communicate by sound: programs, models, scenarios.")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "ferret-datasets, gnuplot-nox, liblcm-bin")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhalocline-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Libraries of Halocline for programs in C++: underwater acoustics, the modem of a vehicle, nodes on the bus.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "halocline (= ${PROJECT_VERSION}), pkg-config, libeigen3-dev, libsleef-dev, libre2-dev, liblcm-dev, libglib2.0-dev, libspdlog-dev, libtomlplusplus-dev, libtbb-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-halocline)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Logs, paths of sound and link budgets of Halocline as NumPy arrays.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
math(EXPR next_minor "${Python_VERSION_MINOR} + 1")  # a module is of one version of Python
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "halocline (= ${PROJECT_VERSION}), python3-numpy, \
python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor})")
include(CPack)
