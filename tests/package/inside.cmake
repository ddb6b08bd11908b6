# SPDX-License-Identifier: BSD-3-Clause
#
# A consumer that has Lacuna, in the folder LACUNA_DIR, as a part of its project: without tests and examples.

include("${CMAKE_CURRENT_LIST_DIR}/checks.cmake")
foreach(target IN ITEMS test_core lacuna_test_main cartilage)
  if(TARGET ${target})
    message(FATAL_ERROR "${target} is built inside another project")
  endif()
endforeach()
get_property(tests DIRECTORY "${LACUNA_DIR}" PROPERTY TESTS)
if(tests)
  message(FATAL_ERROR "tests are added to another project: ${tests}")
endif()
get_target_property(system lacuna SYSTEM)
if(NOT system)
  message(FATAL_ERROR "another project gets our headers not as system headers: it would see their warnings")
endif()
# CMake writes the install rules at the end of the configuration: run.cmake checks them.
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/every_header.hpp" "")

add_executable(consumer "${CMAKE_CURRENT_LIST_DIR}/consumer.cpp")
target_include_directories(consumer PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
target_link_libraries(consumer PRIVATE lacuna::all)
