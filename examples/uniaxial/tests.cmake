# SPDX-License-Identifier: BSD-3-Clause
#
# Tests of the program as a person uses it: one ctest test per case of check.cmake.

foreach(case IN ITEMS refusals files equilibrium)
  add_test(NAME "uniaxial: ${case}"
    COMMAND "${CMAKE_COMMAND}" -D "CASE=${case}" -D "PROGRAM=$<TARGET_FILE:uniaxial>"
      -D "SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/check/${case}" -P "${CMAKE_CURRENT_LIST_DIR}/check.cmake")
  set_tests_properties("uniaxial: ${case}" PROPERTIES LABELS program TIMEOUT 300)
endforeach()
