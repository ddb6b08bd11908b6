# SPDX-License-Identifier: BSD-3-Clause
#
# Checks of the targets that a consumer gets.

# every_header(<folder>): writes every_header.hpp, which includes all headers below the folder.
function(every_header folder)
  file(GLOB_RECURSE headers RELATIVE "${folder}" "${folder}/lacuna/*.hpp")
  list(LENGTH headers count)
  if(count EQUAL 0)
    message(FATAL_ERROR "no header below ${folder}/lacuna")
  endif()
  list(SORT headers)
  set(text "")
  foreach(header IN LISTS headers)
    string(APPEND text "#include <${header}>\n")
  endforeach()
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/every_header.hpp" "${text}")
endfunction()

string(REPLACE "," ";" EXPECTED_COMPONENTS "${EXPECTED_COMPONENTS}")
foreach(name IN ITEMS lacuna all ${EXPECTED_COMPONENTS})
  if(NOT TARGET lacuna::${name})
    message(FATAL_ERROR "there is no target lacuna::${name}")
  endif()
  get_target_property(options lacuna::${name} INTERFACE_COMPILE_OPTIONS)
  if(options)
    message(FATAL_ERROR "lacuna::${name} forces compiler options on its user: ${options}")
  endif()
endforeach()
# A consumer may turn on all warnings, and treat them as errors.
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  add_compile_options(-Wall -Wextra -Wconversion -Wsign-conversion -Werror)
endif()
string(REPLACE "," ";" OTHER_COMPONENTS "${OTHER_COMPONENTS}")
foreach(name IN LISTS OTHER_COMPONENTS)
  if(TARGET lacuna::${name})
    message(FATAL_ERROR "there is a target lacuna::${name}, although this component is off")
  endif()
endforeach()
