# SPDX-License-Identifier: BSD-3-Clause
#
# Flags of the programs built here. None of them is on an exported target: a user's flags are the user's.

add_library(lacuna_warnings INTERFACE)
add_library(lacuna_numerics INTERFACE)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(lacuna_warnings INTERFACE -Wall -Wextra -Wshadow -Wpedantic
    $<$<BOOL:${LACUNA_WERROR}>:-Werror>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # Programs with a precompiled header read it there: nothing may come before that.
    set(compiled_before "$<TARGET_PROPERTY:PRECOMPILE_HEADERS>$<TARGET_PROPERTY:PRECOMPILE_HEADERS_REUSE_FROM>")
    target_compile_options(lacuna_warnings INTERFACE
      "$<$<NOT:$<BOOL:${compiled_before}>>:SHELL:-include \"${CMAKE_CURRENT_LIST_DIR}/quiet_string.hpp\">")
  endif()
  # No test of errno and no care for traps, so that square roots and selections become vector instructions. Products
  # and sums may be contracted: a run has the same bits on any number of threads because all of them run the same
  # functions. Tests compare the plain and the packed form of a formula bit by bit: there contraction is off.
  target_compile_options(lacuna_numerics INTERFACE -fno-math-errno -fno-trapping-math)
endif()

# lacuna_add_program(name sources...): an executable with the library, all components that were found, and our
# flags. LACUNA_HAS_<COMPONENT> is defined for each of these.
function(lacuna_add_program name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE lacuna::all lacuna_warnings lacuna_numerics)
  foreach(component IN LISTS lacuna_built_components)
    string(TOUPPER ${component} upper)
    target_compile_definitions(${name} PRIVATE LACUNA_HAS_${upper})
  endforeach()
endfunction()
