# SPDX-License-Identifier: BSD-3-Clause
#
# Compiles HEADERS (relative to INCLUDE) as a consumer does. COMPLETE: these are all headers of the library.
#   CHECK=warnings: there is no warning with all warnings on, in the language STANDARD.
#   CHECK=older: an older language is refused by one line that names the language that is needed.
#   CHECK=pragmas: a warning that a header turns off for itself is on again after it.
#   CHECK=macros: the headers define no macros except ours and those of the libraries that a consumer includes anyway.

cmake_minimum_required(VERSION 3.25)

file(MAKE_DIRECTORY "${SCRATCH}")
set(text "")
foreach(header IN LISTS HEADERS)
  string(APPEND text "#include <${header}>\n")
endforeach()
if(COMPLETE)
  string(APPEND text "#define CONSUMER_HAS_ALL_HEADERS\n")
endif()
file(WRITE "${SCRATCH}/every_header.hpp" "${text}")

set(folders -I "${SCRATCH}" -I "${INCLUDE}")
foreach(folder IN LISTS SYSTEM_DIRS)
  if(folder AND NOT folder MATCHES "^/usr/include/?$" AND NOT folder STREQUAL INCLUDE)
    list(APPEND folders -isystem "${folder}")
  endif()
endforeach()

# compile(<result> <text> arguments...): sets the compiler's exit status and its output.
function(compile result text)
  execute_process(COMMAND "${COMPILER}" ${folders} ${ARGN} RESULT_VARIABLE found ERROR_VARIABLE said
    OUTPUT_VARIABLE out)
  set(${result} "${found}" PARENT_SCOPE)
  set(${text} "${said}${out}" PARENT_SCOPE)
endfunction()

if(CHECK STREQUAL "warnings")
  compile(result said -std=${STANDARD} -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror
    -fsyntax-only "${CMAKE_CURRENT_LIST_DIR}/every_header.cpp")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${COMPILER} -std=${STANDARD} warns a consumer:\n${said}")
  endif()
elseif(CHECK STREQUAL "older")
  foreach(header IN LISTS HEADERS)
    file(WRITE "${SCRATCH}/older.cpp" "#include <${header}>\n")
    compile(result said -std=c++17 -fsyntax-only "${SCRATCH}/older.cpp")
    string(REGEX MATCHALL "error:" errors "${said}")
    list(LENGTH errors count)
    if(result EQUAL 0 OR NOT said MATCHES "error: [#\"]*(error )?Lacuna needs C\\+\\+20" OR count GREATER 2)
      message(FATAL_ERROR "<${header}> with -std=c++17 is not stopped by one line that says what is needed:\n${said}")
    endif()
  endforeach()
elseif(CHECK STREQUAL "pragmas")
  # The program has a function that returns 64 bytes in a register, which warns without AVX-512, and an uninitialized
  # variable.
  file(WRITE "${SCRATCH}/pragmas.cpp" "#include \"every_header.hpp\"
typedef double eight __attribute__((vector_size(64)));
eight twice(eight x) { return x + x; }
int uninitialized(int n) { int x; for (int i = 0; i < n; ++i) x = i; return x; }
")
  compile(result said -std=c++20 -O2 -Wall -Wpsabi -Wmaybe-uninitialized -c -o "${SCRATCH}/pragmas.o"
    "${SCRATCH}/pragmas.cpp")
  foreach(warning IN ITEMS "psabi" "uninitialized")
    if(NOT said MATCHES "pragmas\\.cpp[^\n]*-W[a-z-]*${warning}")
      message(FATAL_ERROR "a header turns -W${warning} off for its consumer:\n${said}")
    endif()
  endforeach()
elseif(CHECK STREQUAL "macros")
  set(libraries_of_components "")
  foreach(header IN ITEMS cairo.h cairo-svg.h zlib.h)
    string(APPEND libraries_of_components "#if __has_include(<${header}>)\n#include <${header}>\n#endif\n")
  endforeach()
  file(WRITE "${SCRATCH}/libraries.cpp" "#include <bits/stdc++.h>
#include <cfloat>
#include <csetjmp>
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <nanoflann.hpp>
#include <immintrin.h>
${libraries_of_components}
#include <sys/wait.h>
#include <unistd.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/file.h>
#include <cxxabi.h>
")
  file(WRITE "${SCRATCH}/ours.cpp" "#include \"every_header.hpp\"\n")
  foreach(which IN ITEMS libraries ours)
    compile(result said -std=c++20 -E -dM "${SCRATCH}/${which}.cpp")
    if(NOT result EQUAL 0)
      message(FATAL_ERROR "${which}.cpp does not compile:\n${said}")
    endif()
    string(REGEX MATCHALL "#define [A-Za-z][A-Za-z0-9_]*" ${which} "${said}")
  endforeach()
  list(REMOVE_ITEM ours ${libraries})
  # Qhull's include guards must stay, else its headers could be read twice.
  list(FILTER ours EXCLUDE REGEX "#define (LACUNA_|CONSUMER_|CEREAL_|qhDEF)")
  if(ours)
    list(JOIN ours "\n  " report)
    message(FATAL_ERROR "the headers leave macros:\n  ${report}")
  endif()
else()
  message(FATAL_ERROR "CHECK=${CHECK} is unknown")
endif()
