# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D TIDY=<clang-tidy> -D HEADERS=<list> -D INCLUDE=<include/> -D SYSTEM_DIRS=<list> -D SCRATCH=<folder> -P
# function_size.cmake: no function of a header has more than 60 lines, as clang-tidy's readability-function-size counts
# them.

cmake_minimum_required(VERSION 3.25)

set(LIMIT 60)
# Exceptions: "<header> <function>", each with its reason above it.
set(EXCEPTIONS
  # One branch for each number of members: the language takes no struct apart in any other way.
  "core/aggregate.hpp with_members"
  # One branch for each width of registers.
  "core/records.hpp transpose_store"
  # A list of names, one a line.
  "simulation/slot_names.hpp refuse_misspelt_slots"
)

file(MAKE_DIRECTORY "${SCRATCH}")
set(source "")
foreach(header IN LISTS HEADERS)
  string(APPEND source "#include <${header}>\n")
endforeach()
file(WRITE "${SCRATCH}/all.cpp" "${source}")
set(flags -std=c++20 "-I${INCLUDE}")
foreach(directory IN LISTS SYSTEM_DIRS)
  # Not /usr/include, which would come before the own folders of the compiler; nor ours, whose warnings would be hidden.
  if(directory AND NOT directory MATCHES "^(/usr/include|${INCLUDE})$")
    list(APPEND flags -isystem "${directory}")
  endif()
endforeach()
execute_process(
  COMMAND "${TIDY}" "--checks=-*,readability-function-size" "--header-filter=.*"
    "--config={CheckOptions: [{key: readability-function-size.LineThreshold, value: ${LIMIT}}, {key: readability-function-size.StatementThreshold, value: 100000}]}"
    "${SCRATCH}/all.cpp" -- ${flags}
  OUTPUT_VARIABLE found ERROR_VARIABLE errors RESULT_VARIABLE result)
if(found MATCHES "error:" OR NOT errors MATCHES "warnings? generated")
  message(FATAL_ERROR "clang-tidy did not read the headers:\n${found}${errors}")
endif()

set(problems "")
set(met "")
# After each warning with the function's name comes a note with its lines.
string(REGEX MATCHALL "include/lacuna/[^\n]*: (warning: function '[^']*'|note: [0-9]+ lines)" lines "${found}")
foreach(line IN LISTS lines)
  if(line MATCHES "include/lacuna/([^:]+):([0-9]+):[0-9]+: warning: function '([^']*)'")
    set(name "${CMAKE_MATCH_1} ${CMAKE_MATCH_3}")
    set(where "${CMAKE_MATCH_2}")
  elseif(line MATCHES "note: ([0-9]+) lines")
    list(APPEND met "${name}")
    if(NOT name IN_LIST EXCEPTIONS)
      list(APPEND problems "${name}, line ${where}: ${CMAKE_MATCH_1} lines, at most ${LIMIT}")
    endif()
  endif()
endforeach()
foreach(exception IN LISTS EXCEPTIONS)
  if(NOT exception IN_LIST met)
    list(APPEND problems "${exception}: an exception that is not needed")
  endif()
endforeach()
if(problems)
  list(JOIN problems "\n" text)
  message(FATAL_ERROR "functions that are too long:\n${text}")
endif()
