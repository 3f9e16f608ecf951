# SPDX-License-Identifier: BSD-3-Clause
# Writes OUT, of IN with the commit of the tree: cmake -D IN= -D OUT= -D SOURCE= [-D what IN names] -P commit.cmake
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(COMMIT unknown)
endif()
configure_file(${IN} ${OUT} @ONLY)
