# SPDX-License-Identifier: BSD-3-Clause
#
# Tests of the program through its command line: one test of ctest for each case of check.cmake.

foreach(case IN ITEMS refusals pack run dry same_twice no_overwrite owner interrupted unstable equilibrium
  equilibrium_refusals equilibrium_mechanism equilibrium_study study_refusals study choices sensitivity calibrate)
  add_test(NAME "cartilage: ${case}"
    COMMAND "${CMAKE_COMMAND}" -D "CASE=${case}" -D "PROGRAM=$<TARGET_FILE:cartilage>"
      -D "SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/check/${case}" -P "${CMAKE_CURRENT_LIST_DIR}/check.cmake")
  set_tests_properties("cartilage: ${case}" PROPERTIES LABELS program TIMEOUT 600)
endforeach()
