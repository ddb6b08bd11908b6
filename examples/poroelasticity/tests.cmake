# SPDX-License-Identifier: BSD-3-Clause
#
# Tests of the program as a person uses it: one ctest test per case of check.cmake.

foreach(case IN ITEMS refusals files stopped terzaghi mandel cryer darcy creep relaxation slow_terzaghi slow_mandel
    slow_cryer)
  add_test(NAME "poroelasticity: ${case}"
    COMMAND "${CMAKE_COMMAND}" -D "CASE=${case}" -D "PROGRAM=$<TARGET_FILE:poroelasticity>"
      -D "SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/check/${case}" -P "${CMAKE_CURRENT_LIST_DIR}/check.cmake")
  set_tests_properties("poroelasticity: ${case}" PROPERTIES LABELS program TIMEOUT 600)
endforeach()
