# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D ROOT=... -D OUT=... -D BUILD=... -D DRAWING=... -P code_version.cmake
# Writes a header with a hash of everything that determines a run's results: the library's headers, the program's
# sources, the compiler and its flags. DRAWING lists sources that only draw or choose, by their paths in
# examples/cartilage. The hash does not depend on the location of the repository.

cmake_minimum_required(VERSION 3.25)

file(GLOB_RECURSE sources RELATIVE "${ROOT}" "${ROOT}/include/lacuna/*.hpp")
file(GLOB_RECURSE own RELATIVE "${ROOT}" "${ROOT}/examples/cartilage/*.hpp" "${ROOT}/examples/cartilage/*.cpp")
list(APPEND sources ${own})
list(SORT sources)
set(text "${BUILD}\n")
foreach(source IN LISTS sources)
  string(REGEX REPLACE "^examples/cartilage/" "" name "${source}")
  if(name IN_LIST DRAWING)
    continue()
  endif()
  file(SHA256 "${ROOT}/${source}" hash)
  string(APPEND text "${source} ${hash}\n")
endforeach()
string(SHA256 hash "${text}")
string(SUBSTRING "${hash}" 0 16 hash)
file(CONFIGURE OUTPUT "${OUT}" CONTENT "// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#define CARTILAGE_CODE_VERSION \"@hash@\"
")
