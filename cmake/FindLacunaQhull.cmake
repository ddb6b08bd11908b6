# SPDX-License-Identifier: BSD-3-Clause
#
# Qhull's reentrant C library as the target LacunaQhull::qhull_r, from its own package where that works, from the
# file system otherwise.

if(NOT TARGET LacunaQhull::qhull_r)
  find_package(Qhull QUIET CONFIG)
  if(TARGET Qhull::qhull_r)
    set(LacunaQhull_LIBRARY Qhull::qhull_r)
    set(LacunaQhull_FROM "${Qhull_DIR}")
  else()
    find_path(LacunaQhull_INCLUDE_DIR libqhull_r/libqhull_r.h)
    find_library(LacunaQhull_LIBRARY NAMES qhull_r qhullstatic_r)
    mark_as_advanced(LacunaQhull_INCLUDE_DIR LacunaQhull_LIBRARY)
    if(LacunaQhull_INCLUDE_DIR AND LacunaQhull_LIBRARY)
      set(LacunaQhull_FROM "${LacunaQhull_LIBRARY}")
    endif()
  endif()
else()
  set(LacunaQhull_FROM "found before")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LacunaQhull REQUIRED_VARS LacunaQhull_FROM)

if(LacunaQhull_FOUND AND NOT TARGET LacunaQhull::qhull_r)
  add_library(LacunaQhull::qhull_r INTERFACE IMPORTED)
  set_target_properties(LacunaQhull::qhull_r PROPERTIES INTERFACE_LINK_LIBRARIES "${LacunaQhull_LIBRARY}")
  if(LacunaQhull_INCLUDE_DIR)
    set_target_properties(LacunaQhull::qhull_r PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${LacunaQhull_INCLUDE_DIR}")
  endif()
endif()
