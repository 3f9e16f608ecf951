# What every target of ours is compiled with: link it as `halocline_options` (PRIVATE).
add_library(halocline_options INTERFACE)
target_compile_options(halocline_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  # GCC 12 sees overlapping copies in every optimised concatenation of texts (GCC bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<CONFIG:Debug>>>:-Wno-restrict>
  # A fused multiply-add rounds once where two operations round twice: results would depend on the
  # optimisation level and the processor. The same scenario has to give the same bytes everywhere.
  -ffp-contract=off)
target_include_directories(halocline_options INTERFACE ${CMAKE_SOURCE_DIR})

if(HALOCLINE_SANITIZE)
  add_compile_options(-fsanitize=${HALOCLINE_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${HALOCLINE_SANITIZE})
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

# halocline_library(name SOURCES ... LINK ...): a static library of one layer.
function(halocline_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LINK_PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE halocline_options ${ARG_LINK_PRIVATE})
endfunction()

# halocline_program(name SOURCES ... LINK ...): an executable in build/<preset>/bin.
function(halocline_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE halocline_options ${ARG_LINK})
endfunction()
