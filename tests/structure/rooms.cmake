# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D ROOT=<repository> -P rooms.cmake: the rules that keep the rooms of include/lacuna/ apart.

cmake_minimum_required(VERSION 3.25)

# Which rooms a room may include; every room may include itself.
set(ROOMS core particles neighbors laws interactions pores loads motion observe)
set(core_MAY "")
set(particles_MAY core)
set(neighbors_MAY core particles)
set(laws_MAY core)
set(interactions_MAY core particles neighbors laws)
set(pores_MAY core particles laws interactions)
set(loads_MAY core particles)
set(motion_MAY core particles)
set(observe_MAY core)

# Third-party headers and the rooms that may include them.
set(THIRD_PARTY eigen nanoflann qhull cairo cereal zlib intrinsics programs)
set(eigen_HEADERS "^(unsupported/)?Eigen/")
set(eigen_ROOMS core pores motion)
set(nanoflann_HEADERS "^nanoflann")
set(nanoflann_ROOMS neighbors)
set(qhull_HEADERS "^libqhull")
set(qhull_ROOMS pores)
set(cairo_HEADERS "^(cairo/)?cairo")
set(cairo_ROOMS observe)
set(cereal_HEADERS "^cereal/")
set(cereal_ROOMS observe)
set(zlib_HEADERS "^zlib\\.h$")
set(zlib_ROOMS observe)
set(intrinsics_HEADERS "^([a-z]+intrin|arm_neon|arm_sve)\\.h$")
set(intrinsics_ROOMS core)
set(programs_HEADERS "^(CLI|toml\\+\\+|nlohmann|catch2|benchmark)/")
set(programs_ROOMS "")

set(FORBIDDEN_STANDARD "^(iostream|ranges|functional|regex)$")
# What reads and writes numbers as the program's locale says: files are read and written by core/text.hpp. Programs may
# print tables for persons.
set(OF_LOCALES "(strto(f|d|ld)|sto(f|d|ld)|atof|setlocale|localeconv|imbue|setprecision)[ ]*\\(|stringstream|[^f]printf\\([^;]*%[-+ #0-9.*]*L?[aefgAEFG]")
set(MOST_LINES 300)
set(MOST_DEPTH 7)

# Exceptions: "<header> -> <what it may include>", "<header> lines" or "<header> depth", each with its reason above it.
set(EXCEPTIONS
  # core/ alone is a chain of five: fields of records of packs of scalars.
  "interactions/interactions.hpp depth"
  "interactions/force_store.hpp depth"
  # What bonds and contacts do in a step, on one page.
  "interactions/interactions.hpp lines"
  # What all flow solvers share.
  "pores/flow_base.hpp lines"
  "simulation.hpp depth"
  # A solver is its base, which is the passes over a network, which is a mesh of the plane's geometry.
  "pores/explicit_flow.hpp depth"
  "pores/implicit_flow.hpp depth"
  # All that a user calls, and the step, on one page.
  "simulation.hpp lines"
  # A plane has places, paths, forces and stiffnesses, as all pairs have in four headers.
  "interactions/walls.hpp lines"
  # One list and what it is judged by.
  "neighbors/verlet_list.hpp lines"
  "simulation/parameters.hpp depth"
  "simulation/limits.hpp depth"
  "simulation/step_control.hpp depth"
  "simulation/fluid_coupling.hpp depth"
  # All guards, one of which looks at the pores.
  "simulation/run_guards.hpp depth"
  # Stands on top of simulation.hpp.
  "simulation/checkpoint.hpp depth"
  # A specimen is random packing, which is relaxing, which is sorting into a grid.
  "particles/cartilage_specimen.hpp depth"
)

set(problems "")
macro(problem key text)
  if(NOT "${key}" IN_LIST EXCEPTIONS)
    list(APPEND problems "${text}")
  endif()
endmacro()

file(GLOB_RECURSE headers RELATIVE "${ROOT}/include/lacuna" "${ROOT}/include/lacuna/*")
list(SORT headers)
if(NOT headers)
  message(FATAL_ERROR "no header under ${ROOT}/include/lacuna")
endif()

foreach(header IN LISTS headers)
  set(path "${ROOT}/include/lacuna/${header}")
  set(room "")
  if(header MATCHES "^([^/]+)/")
    set(room "${CMAKE_MATCH_1}")
    if(room STREQUAL "simulation")
      # The parts of simulation.hpp, the one place that knows all rooms; no room may include it.
      set(room "")
    elseif(NOT room IN_LIST ROOMS)
      list(APPEND problems "${header}: there is no room ${room}/")
    endif()
  endif()
  if(NOT header MATCHES "\\.hpp$")
    list(APPEND problems "${header}: only .hpp files live in include/lacuna/")
    continue()
  endif()

  file(READ "${path}" text)
  if(NOT text MATCHES "^// SPDX-License-Identifier: BSD-3-Clause\n")
    list(APPEND problems "${header}: the first line must name the licence")
  endif()
  if(NOT text MATCHES "\n#pragma once\n")
    list(APPEND problems "${header}: no #pragma once")
  endif()
  if(text MATCHES "${OF_LOCALES}|fprintf\\([^;]*%[-+ #0-9.*]*L?[aefgAEFG]")
    problem("${header} numbers" "${header}: '${CMAKE_MATCH_0}' goes by the locale, core/text.hpp reads and writes numbers")
  endif()
  string(REGEX REPLACE "[^\n]" "" newlines "${text}")
  string(LENGTH "${newlines}" lines)
  if(lines GREATER MOST_LINES)
    problem("${header} lines" "${header}: ${lines} lines, the most is ${MOST_LINES}")
  endif()

  set(inner_${header} "")
  file(STRINGS "${path}" includes REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS includes)
    if(line MATCHES "include[ \t]*\"([^\"]*)\"")
      list(APPEND problems "${header}: \"${CMAKE_MATCH_1}\" must be included as <lacuna/...>")
      continue()
    elseif(NOT line MATCHES "include[ \t]*<([^>]+)>")
      list(APPEND problems "${header}: cannot read '${line}'")
      continue()
    endif()
    set(name "${CMAKE_MATCH_1}")

    if(name MATCHES "^lacuna/(([^/]+)/.*)$")
      set(target "${CMAKE_MATCH_1}")
      set(other "${CMAKE_MATCH_2}")
      list(APPEND inner_${header} "${target}")
      if(room AND NOT other STREQUAL room AND NOT other IN_LIST ${room}_MAY)
        problem("${header} -> ${target}" "${header}: ${room}/ may not include ${other}/ (${target})")
      endif()
      if(NOT other STREQUAL room AND target MATCHES "/detail/")
        problem("${header} -> ${target}" "${header}: reaches into the detail/ of ${other}/ (${target})")
      endif()
    elseif(name MATCHES "^lacuna/(.*)$")
      list(APPEND inner_${header} "${CMAKE_MATCH_1}")
      if(room)
        problem("${header} -> ${CMAKE_MATCH_1}" "${header}: a room may not include ${CMAKE_MATCH_1}, which knows all rooms")
      endif()
    elseif(name MATCHES "${FORBIDDEN_STANDARD}")
      problem("${header} -> ${name}" "${header}: <${name}> is not for headers")
    else()
      foreach(library IN LISTS THIRD_PARTY)
        if(name MATCHES "${${library}_HEADERS}" AND NOT room IN_LIST ${library}_ROOMS)
          problem("${header} -> ${name}" "${header}: <${name}> is only for ${${library}_ROOMS}")
        endif()
      endforeach()
    endif()
  endforeach()
endforeach()

file(GLOB_RECURSE programs RELATIVE "${ROOT}" "${ROOT}/examples/*.cpp" "${ROOT}/examples/*.hpp")
foreach(program IN LISTS programs)
  file(READ "${ROOT}/${program}" text)
  # printf alone goes to the terminal.
  string(REGEX REPLACE "std::printf\\(" "std::puts(" text "${text}")
  if(text MATCHES "${OF_LOCALES}")
    problem("${program} numbers" "${program}: '${CMAKE_MATCH_0}' goes by the locale, core/text.hpp reads and writes numbers")
  endif()
endforeach()

# Depth by rounds: a header is as deep as the deepest that it includes, plus one; what never settles is a ring.
# core/standard.hpp is below all.
set(depth_core/standard.hpp 0)
set(open ${headers})
list(REMOVE_ITEM open core/standard.hpp)
while(open)
  set(next "")
  foreach(header IN LISTS open)
    set(depth 0)
    foreach(inner IN LISTS inner_${header})
      if(DEFINED depth_${inner})
        if(depth_${inner} GREATER depth)
          set(depth ${depth_${inner}})
        endif()
      elseif(inner IN_LIST headers)
        set(depth open)
        break()
      endif()
    endforeach()
    if(depth STREQUAL "open")
      list(APPEND next "${header}")
    else()
      math(EXPR depth_${header} "${depth} + 1")
      if(depth_${header} GREATER MOST_DEPTH)
        problem("${header} depth" "${header}: includes ${depth_${header}} deep, the most is ${MOST_DEPTH}")
      endif()
    endif()
  endforeach()
  if(next STREQUAL open)
    list(JOIN next ", " ring)
    list(APPEND problems "a ring of includes among or below: ${ring}")
    break()
  endif()
  set(open ${next})
endwhile()

list(LENGTH headers count)
if(problems)
  list(JOIN problems "\n  " report)
  message(FATAL_ERROR "${count} headers, and these break a rule:\n  ${report}")
endif()
message(STATUS "${count} headers keep the rules of their rooms")
