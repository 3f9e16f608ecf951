# SPDX-License-Identifier: BSD-3-Clause
# What every target of ours is compiled with: link it as `halocline_options` (PRIVATE).
add_library(halocline_options INTERFACE)
target_compile_options(halocline_options INTERFACE
  # With it ccache keeps what uses a precompiled header.
  -fpch-preprocess
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  # GCC 12 sees overlapping and endless copies in optimised concatenations of texts (GCC bugs 105651, 105329).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<CONFIG:Debug>>>:-Wno-restrict>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<CONFIG:Debug>>>:-Wno-array-bounds>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<CONFIG:Debug>>>:-Wno-stringop-overread>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<CONFIG:Debug>>>:-Wno-stringop-overflow>
  # A fused multiply-add rounds once where two operations round twice: results would depend on the
  # optimisation level and the processor. The same scenario has to give the same bytes everywhere.
  -ffp-contract=off
  # GCC makes vfmaddsub all the same where it builds for processors that have it, and Eigen takes them by name and sums in
  # wider vectors.
  $<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},x86_64>:-mno-fma>
  -U__ARM_FEATURE_FMA -U__AVX__ -U__AVX2__ -U__AVX512F__
  # Nothing reads errno or floating-point exceptions: a root is one instruction, and loops with comparisons and roots
  # become vectors, of the same values.
  -fno-math-errno -fno-trapping-math
  # GCC looks for unused memory of its own only beyond 600 MB: a tenth of the time of a build.
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=600000>)
target_include_directories(halocline_options INTERFACE ${CMAKE_SOURCE_DIR})

if(HALOCLINE_SANITIZE)
  add_compile_options(-fsanitize=${HALOCLINE_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${HALOCLINE_SANITIZE})
  add_compile_options(-Wno-maybe-uninitialized)  # GCC 12 sees uninitialised members in instrumented std::function and std::regex
  if(HALOCLINE_SANITIZE MATCHES undefined)
    # GCC 12's vptr check of a call through a pointer to member, as LCM's header makes it, reads a temporary that
    # was never set and crashes on correct code.
    add_compile_options(-fno-sanitize=vptr)
  endif()
endif()

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# What nearly every file includes, parsed once: it halves the time of a build. Files still include what they use
# (scripts/check_includes looks), and a target whose options change a macro of these headers does without (NO_COMMON_HEADERS).
# Presets that build everything also compile several sources at a time (CMAKE_UNITY_BUILD; docs/decisions/precompiled-headers.md).
set(HALOCLINE_COMMON_HEADERS
  <Eigen/Dense> <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numbers> <optional> <set> <span>
  <sstream> <stdexcept> <string> <string_view> <tuple> <utility> <vector>)
foreach(headers halocline_library_headers halocline_text_headers)
  add_library(${headers} OBJECT ${CMAKE_CURRENT_LIST_DIR}/common_headers.cc)
  target_link_libraries(${headers} PRIVATE halocline_options Eigen3::Eigen)
  target_precompile_headers(${headers} PRIVATE ${HALOCLINE_COMMON_HEADERS})
endforeach()
set(HALOCLINE_HEADERS halocline_library_headers)  # which of them targets of a folder use

# halocline_optimise_for_build_time(): targets of this folder, and of folders it adds from here on, are compiled at -O1: rooms that turn
# messages into text, JSON and pages, which costs twice as long at -O3 and gains nothing that a user sees.
target_compile_options(halocline_text_headers PRIVATE $<$<CONFIG:Release>:-O1>)
macro(halocline_optimise_for_build_time)
  set(HALOCLINE_HEADERS halocline_text_headers)
  add_compile_options($<$<CONFIG:Release>:-O1>)
endmacro()

# halocline_library(name SOURCES ... LINK ... [NO_COMMON_HEADERS]): a static library of one layer.
function(halocline_library name)
  cmake_parse_arguments(ARG "NO_COMMON_HEADERS" "" "SOURCES;LINK;LINK_PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>)
  target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE $<BUILD_INTERFACE:halocline_options> ${ARG_LINK_PRIVATE})
  if(NOT ARG_NO_COMMON_HEADERS)
    target_precompile_headers(${name} REUSE_FROM ${HALOCLINE_HEADERS})
  endif()
endfunction()

# halocline_module(name SOURCES ... LINK ...): a shared module beside the programs, loaded when it is first used
# (core/shared_module.h); installed in lib/halocline.
function(halocline_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES PREFIX "" DEFINE_SYMBOL "" LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  target_link_libraries(${name} PRIVATE halocline_options ${ARG_LINK})
  target_precompile_headers(${name} REUSE_FROM ${HALOCLINE_HEADERS})
  install(TARGETS ${name} LIBRARY DESTINATION lib/halocline COMPONENT programs)
endfunction()

# halocline_executable(name SOURCES ... LINK ...): an executable in build/<preset>/bin.
function(halocline_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE halocline_options ${ARG_LINK})
  target_compile_options(${name} PRIVATE -fPIC)  # as the common headers of the libraries
  target_precompile_headers(${name} REUSE_FROM ${HALOCLINE_HEADERS})
endfunction()

# halocline_program(name SOURCES ... LINK ...): the same, of the target `programs`: what a user runs; installed.
add_custom_target(programs)
function(halocline_program name)
  halocline_executable(${name} ${ARGN})
  add_dependencies(programs ${name})
  install(TARGETS ${name} RUNTIME COMPONENT programs)
endfunction()
