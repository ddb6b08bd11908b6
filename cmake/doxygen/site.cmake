# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D SOURCE=<repository> -D OUT=<folder> -D DOXYGEN=<program> -D VERSION=<x.y.z> -P site.cmake: the documentation in
# OUT/html. What stands elsewhere is taken from there: the program and the limits from README.md, the validation page from
# tests/README.md. A warning of Doxygen is an error.

cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE "${OUT}")
file(MAKE_DIRECTORY "${OUT}/pages")
file(GLOB pages "${CMAKE_CURRENT_LIST_DIR}/*.md")
file(COPY ${pages} DESTINATION "${OUT}/pages")

# section(out heading file): the text below a heading of a file, up to the next of its kind.
function(section out heading file)
  file(READ "${SOURCE}/${file}" text)
  string(FIND "${text}" "\n## ${heading}\n" from)
  if(from EQUAL -1)
    message(FATAL_ERROR "${file} has no section '${heading}'")
  endif()
  string(SUBSTRING "${text}" ${from} -1 text)
  string(REPLACE "\n## ${heading}\n" "" text "${text}")
  string(FIND "${text}" "\n## " to)
  string(SUBSTRING "${text}" 0 ${to} text)
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# Links to files of the repository lead nowhere from the site: their text stays.
function(without_links out text)
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\([^)\n]*\\)" "\\1" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

section(program "A program of one's own" README.md)
if(NOT program MATCHES "(```cpp\n[^`]*```)\n\nIt prints `([^`]*)`")
  message(FATAL_ERROR "README.md has no program, or does not say what it prints")
endif()
set(PROGRAM "${CMAKE_MATCH_1}")
set(PRINTS "${CMAKE_MATCH_2}")
configure_file("${CMAKE_CURRENT_LIST_DIR}/main.md.in" "${OUT}/pages/main.md" @ONLY)

section(limits "Not there yet, not validated" README.md)
without_links(limits "${limits}")
file(WRITE "${OUT}/pages/limits.md" "# Limits {#limits}\n${limits}")

file(READ "${SOURCE}/tests/README.md" checks)
without_links(checks "${checks}")
string(REGEX REPLACE "^# ([^\n]*)\n" "# \\1 {#validation}\n" checks "${checks}")
file(WRITE "${OUT}/pages/validation.md" "${checks}")

# Doxygen passes over a name that it does not know: a page must not name what has gone.
file(GLOB_RECURSE headers "${SOURCE}/include/lacuna/*.hpp")
set(code "")
foreach(header IN LISTS headers)
  file(READ "${header}" text)
  string(APPEND code "${text}")
endforeach()
file(GLOB pages "${CMAKE_CURRENT_LIST_DIR}/*.md" "${CMAKE_CURRENT_LIST_DIR}/*.in")
foreach(page IN LISTS pages)
  file(READ "${page}" text)
  string(REGEX MATCHALL "[a-z_]+(::[a-z_0-9]+)+" names "${text}")
  foreach(name IN LISTS names)
    string(REPLACE "::" ";" words "${name}")
    foreach(word IN LISTS words)
      if(NOT code MATCHES "[^a-z_0-9]${word}[^a-z_0-9]")
        message(FATAL_ERROR "${page}: there is no '${word}' (${name}) in include/lacuna")
      endif()
    endforeach()
  endforeach()
  string(REGEX MATCHALL "`[a-z_]+(/[a-z_]+)+\\.hpp`" files "${text}")
  foreach(name IN LISTS files)
    string(REPLACE "`" "" name "${name}")
    if(NOT EXISTS "${SOURCE}/include/lacuna/${name}")
      message(FATAL_ERROR "${page}: there is no header ${name}")
    endif()
  endforeach()
endforeach()

configure_file("${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in" "${OUT}/Doxyfile" @ONLY)
execute_process(COMMAND "${DOXYGEN}" "${OUT}/Doxyfile" RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${said}")
endif()
foreach(page IN ITEMS index motion contacts bonds flow time_step other_codes validation limits)
  if(NOT EXISTS "${OUT}/html/${page}.html")
    message(FATAL_ERROR "there is no page ${page}.html")
  endif()
endforeach()
message(STATUS "documentation: ${OUT}/html/index.html")
