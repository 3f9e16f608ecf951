# Third-party packages. docs/decisions has the reason of each.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(spdlog REQUIRED)
find_package(Threads REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
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

# LCM 1.3.1 (Debian) has no CMake package, 1.5 (upstream) has one whose target differs: find the header,
# the library and the generator ourselves, so that both work.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)
add_library(halocline_lcm INTERFACE)
target_include_directories(halocline_lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
target_link_libraries(halocline_lcm INTERFACE ${LCM_LIBRARY} Threads::Threads)
