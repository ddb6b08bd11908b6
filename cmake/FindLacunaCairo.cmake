# SPDX-License-Identifier: BSD-3-Clause
#
# cairo with its PNG and SVG surfaces as the target LacunaCairo::cairo; headers are included as <cairo.h>,
# <cairo-svg.h>.

if(NOT TARGET LacunaCairo::cairo)
  find_path(LacunaCairo_INCLUDE_DIR cairo.h PATH_SUFFIXES cairo)
  find_library(LacunaCairo_LIBRARY NAMES cairo)
  mark_as_advanced(LacunaCairo_INCLUDE_DIR LacunaCairo_LIBRARY)
  set(LacunaCairo_SURFACES FALSE)
  if(LacunaCairo_INCLUDE_DIR AND EXISTS "${LacunaCairo_INCLUDE_DIR}/cairo-features.h")
    file(STRINGS "${LacunaCairo_INCLUDE_DIR}/cairo-features.h" surfaces
      REGEX "define CAIRO_HAS_(PNG_FUNCTIONS|SVG_SURFACE) 1")
    list(LENGTH surfaces count)
    if(count EQUAL 2)
      set(LacunaCairo_SURFACES TRUE)
    endif()
  endif()
else()
  set(LacunaCairo_SURFACES TRUE)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LacunaCairo
  REQUIRED_VARS LacunaCairo_LIBRARY LacunaCairo_INCLUDE_DIR LacunaCairo_SURFACES)

if(LacunaCairo_FOUND AND NOT TARGET LacunaCairo::cairo)
  add_library(LacunaCairo::cairo INTERFACE IMPORTED)
  set_target_properties(LacunaCairo::cairo PROPERTIES
    INTERFACE_LINK_LIBRARIES "${LacunaCairo_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LacunaCairo_INCLUDE_DIR}")
endif()
