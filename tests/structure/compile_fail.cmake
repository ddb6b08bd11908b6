# SPDX-License-Identifier: BSD-3-Clause
#
# SOURCE must not compile, and the compiler's message must contain the text of its line "// refused: <text>". With
# -DLACUNA_GOOD it must compile, so that the refusal has no other reason. The message must have fewer than 20 lines. A
# file with lines "// refused with <MACRO>: <text>" must compile as it is, and be refused with that text when the macro
# is defined. With HEADERS, a precompiled header that includes all of the simulator, its headers are read from there.
# WRITE_HEADERS=<file>: writes that header instead.

cmake_minimum_required(VERSION 3.25)

set(command "${COMPILER}" -std=c++20)
foreach(folder IN LISTS INCLUDE_DIRS)
  if(folder AND NOT folder MATCHES "^/usr/include/?$")
    list(APPEND command -I "${folder}")
  endif()
endforeach()

if(WRITE_HEADERS)
  file(WRITE "${WRITE_HEADERS}" "#include <lacuna/simulation.hpp>\n")
  execute_process(COMMAND ${command} -x c++-header "${WRITE_HEADERS}" -o "${WRITE_HEADERS}.gch"
    COMMAND_ERROR_IS_FATAL ANY)
  return()
endif()
file(STRINGS "${SOURCE}" simulator REGEX "^#include <lacuna/simulation.hpp>")
if(HEADERS AND simulator)
  list(APPEND command -include "${HEADERS}")
endif()
list(APPEND command -fsyntax-only)

function(compiles)
  execute_process(COMMAND ${command} ${ARGN} "${SOURCE}" RESULT_VARIABLE good ERROR_VARIABLE said OUTPUT_QUIET)
  if(NOT good EQUAL 0)
    message(FATAL_ERROR "with '${ARGN}' it should compile:\n${said}")
  endif()
endfunction()

function(refused expected)
  execute_process(COMMAND ${command} ${ARGN} "${SOURCE}" RESULT_VARIABLE bad ERROR_VARIABLE said OUTPUT_QUIET)
  if(bad EQUAL 0)
    message(FATAL_ERROR "with '${ARGN}' it compiles, but should be refused with '${expected}'")
  endif()
  string(FIND "${said}" "${expected}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "with '${ARGN}' refused, but without '${expected}':\n${said}")
  endif()
  string(REGEX MATCHALL "\n" ends "${said}")
  list(LENGTH ends lines)
  if(NOT lines LESS 20)
    message(FATAL_ERROR "with '${ARGN}' the refusal has ${lines} lines, 20 or more:\n${said}")
  endif()
endfunction()

file(STRINGS "${SOURCE}" faults REGEX "^// refused with [A-Z_]+: ")
if(faults)
  compiles()
  foreach(fault IN LISTS faults)
    string(REGEX MATCH "^// refused with ([A-Z_]+): (.*)$" all "${fault}")
    refused("${CMAKE_MATCH_2}" "-D${CMAKE_MATCH_1}")
  endforeach()
else()
  file(STRINGS "${SOURCE}" expected REGEX "^// refused: ")
  if(NOT expected)
    message(FATAL_ERROR "${SOURCE} has no line '// refused: <text>'")
  endif()
  string(REGEX REPLACE "^// refused: " "" expected "${expected}")
  compiles(-DLACUNA_GOOD)
  refused("${expected}")
endif()
