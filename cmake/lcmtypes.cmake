# halocline_generate_cpp(out_headers FILES...): runs the installed lcm-gen; headers land in the build tree,
# never in the repository, because generated code belongs to the LCM that generated it.
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
  set(${out_headers} ${headers} PARENT_SCOPE)
endfunction()
