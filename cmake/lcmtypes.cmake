# SPDX-License-Identifier: BSD-3-Clause
# halocline_generate_cpp(out_headers FILES...): runs the installed lcm-gen and lcmtypes/generate.py; headers land in
# the build tree, never in the repository, because generated code belongs to the LCM that generated it.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

function(halocline_generate_cpp out_headers)
  set(headers)
  foreach(type_file ${ARGN})
    get_filename_component(type ${type_file} NAME_WE)
    set(header ${CMAKE_BINARY_DIR}/lcmtypes/halocline/${type}.hpp)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${LCM_GEN} --cpp --cpp-std c++11 --cpp-hpath ${CMAKE_BINARY_DIR}/lcmtypes ${type_file}
      DEPENDS ${type_file}
      COMMENT "lcm-gen ${type}")
    list(APPEND headers ${header})
  endforeach()
  set(made channel_table channels message_fields messages)
  list(TRANSFORM made PREPEND ${CMAKE_BINARY_DIR}/generated/bus/messages/)
  list(TRANSFORM made APPEND .h)
  set(generate ${CMAKE_SOURCE_DIR}/lcmtypes/generate.py)
  add_custom_command(
    OUTPUT ${made}
    COMMAND ${Python3_EXECUTABLE} ${generate} --cpp ${CMAKE_BINARY_DIR}/generated
    DEPENDS ${generate} ${CMAKE_SOURCE_DIR}/lcmtypes/channels.toml ${ARGN}
    COMMENT "lcmtypes/generate.py")
  set(${out_headers} ${headers} ${made} PARENT_SCOPE)
endfunction()
