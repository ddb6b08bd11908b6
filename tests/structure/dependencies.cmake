# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D ROOT=<repository> -P dependencies.cmake: cmake/dependencies.sh knows each name by which a script or a
# document calls it.

cmake_minimum_required(VERSION 3.25)

set(ENV{LACUNA_SKIP_DEPENDENCIES} 1)
function(is_known out name)
  execute_process(COMMAND sh "${ROOT}/cmake/dependencies.sh" "${name}" RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  set(known FALSE)
  if(result EQUAL 0)
    set(known TRUE)
  endif()
  set(${out} ${known} PARENT_SCOPE)
endfunction()

file(GLOB files "${ROOT}/*.md" "${ROOT}/.ci/run" "${ROOT}/cmake/*.sh" "${ROOT}/cmake/doxygen/*" "${ROOT}/bench/*.sh"
  "${ROOT}/*/README.md" "${ROOT}/examples/*/README.md" "${ROOT}/tests/CMakeLists.txt")
set(calls 0)
foreach(file IN LISTS files)
  file(READ "${file}" text)
  string(REGEX MATCHALL "sh [^\n ]*dependencies\\.sh\"? +[a-z][a-z-]*" found "${text}")
  foreach(call IN LISTS found)
    string(REGEX REPLACE ".* " "" name "${call}")
    is_known(known "${name}")
    if(NOT known)
      message(FATAL_ERROR "${file}: cmake/dependencies.sh knows no ${name}")
    endif()
    math(EXPR calls "${calls} + 1")
  endforeach()
endforeach()
is_known(known no-such-name)
if(known OR calls LESS 8)
  message(FATAL_ERROR "looks at nothing: ${calls} calls")
endif()
message(STATUS "${calls} calls of cmake/dependencies.sh")
