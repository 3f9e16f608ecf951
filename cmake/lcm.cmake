# SPDX-License-Identifier: BSD-3-Clause
# LCM 1.3.1 (Debian) has no CMake package, 1.5 (upstream) has one whose target differs: find the header and
# the library ourselves, so that both work. The installed package does the same.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
add_library(Halocline::lcm INTERFACE IMPORTED)
target_include_directories(Halocline::lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
target_link_libraries(Halocline::lcm INTERFACE ${LCM_LIBRARY} Threads::Threads)
