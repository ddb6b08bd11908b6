# SPDX-License-Identifier: BSD-3-Clause
#
# Two objects that share a simulation. Compiled for the same registers, they link. Compiled for different ones, they do
# not, and the linker names the widths.

cmake_minimum_required(VERSION 3.25)

file(MAKE_DIRECTORY "${SCRATCH}")
set(command "${COMPILER}" -std=c++20 -O0)
foreach(folder IN LISTS INCLUDE_DIRS)
  if(folder AND NOT folder MATCHES "^/usr/include/?$")
    list(APPEND command -I "${folder}")
  endif()
endforeach()

function(compile source architecture object)
  execute_process(COMMAND ${command} "-march=${architecture}" -c "${CMAKE_CURRENT_LIST_DIR}/mixed_widths/${source}"
    -o "${SCRATCH}/${object}"
    RESULT_VARIABLE failed ERROR_VARIABLE said)
  if(failed)
    message(FATAL_ERROR "${source} should compile for ${architecture}:\n${said}")
  endif()
endfunction()
function(link result said)
  list(TRANSFORM ARGN PREPEND "${SCRATCH}/")
  execute_process(COMMAND "${COMPILER}" ${ARGN} -o "${SCRATCH}/program" RESULT_VARIABLE failed ERROR_VARIABLE error
    OUTPUT_VARIABLE out)
  set(${result} "${failed}" PARENT_SCOPE)
  set(${said} "${error}${out}" PARENT_SCOPE)
endfunction()

compile(defines.cpp x86-64 defines_16.o)
compile(uses.cpp x86-64 uses_16.o)
compile(uses.cpp x86-64-v3 uses_32.o)
link(failed said defines_16.o uses_16.o)
if(failed)
  message(FATAL_ERROR "objects for the same registers should link:\n${said}")
endif()
link(failed said defines_16.o uses_32.o)
if(NOT failed)
  message(FATAL_ERROR "objects for different registers link, but should not")
endif()
if(NOT said MATCHES "count\\(lacuna::packs_of_32_bytes::simulation<own_model> const&\\)")
  message(FATAL_ERROR "the linker does not name the width:\n${said}")
endif()
