# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D PROGRAM=... -D SCRATCH=... -P check.cmake: compares apertures of the loaded pair with numbers by hand.

cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE "${SCRATCH}")
file(MAKE_DIRECTORY "${SCRATCH}")
execute_process(COMMAND "${PROGRAM}" "${SCRATCH}/pair" RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT result STREQUAL "0")
  message(FATAL_ERROR "exit status ${result}\n${out}${err}")
endif()

# expect(law force aperture conductance): in nN, fm and 1e-27 m^3/(Pa s), whole numbers, correct to 1 in 1000.
# Bond 1e4 N/m; a_0 = 10 nm, F_0 = F_d = 0.1 mN, a_inf = 1 nm, h = 1; C = 3.5e-6 / (12 * 1e-3) a^3 / 3e-6.
function(expect law force aperture conductance)
  if(NOT out MATCHES "${law} +${force} +([0-9]+) +([0-9]+)\n")
    message(FATAL_ERROR "no line for ${law} at ${force} nN in\n${out}")
  endif()
  foreach(pair IN ITEMS "${CMAKE_MATCH_1};${aperture}" "${CMAKE_MATCH_2};${conductance}")
    list(GET pair 0 found)
    list(GET pair 1 wanted)
    math(EXPR off "1000 * (${found} - ${wanted})")
    if(off GREATER wanted OR off LESS -${wanted})
      message(FATAL_ERROR "${law} at ${force} nN: ${found} instead of ${wanted}")
    endif()
  endforeach()
endfunction()

# Pressed by 0.1 mN: a_0; a_0 / 2; a_r; a_inf + (a_0 - a_inf) / e. Pulled by 0.1 mN the gap is 10 nm.
expect(constant -100000 10000000 97222)
expect(contact_force -100000 5000000 12153)
expect(cubic_crack -100000 10000000 97222)
expect(exponential -100000 4310915 7789)
expect(constant 100000 10000000 97222)
expect(contact_force 100000 20000000 777778)
expect(cubic_crack 100000 20000000 777778)
expect(exponential 100000 20000000 777778)

foreach(ending IN ITEMS csv png)
  if(NOT EXISTS "${SCRATCH}/pair.${ending}")
    message(FATAL_ERROR "no pair.${ending}")
  endif()
endforeach()
file(STRINGS "${SCRATCH}/pair.csv" rows)
list(LENGTH rows count)
# A heading, and 4 laws at 401 forces.
if(NOT count EQUAL 1605)
  message(FATAL_ERROR "pair.csv has ${count} lines")
endif()

execute_process(COMMAND "${PROGRAM}" "${SCRATCH}/nowhere/pair" RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE err)
if(result STREQUAL "0" OR NOT err MATCHES "cannot write")
  message(FATAL_ERROR "a folder that is not there: exit status ${result}, ${err}")
endif()
