# SPDX-License-Identifier: BSD-3-Clause
#
# What is installed beside the targets and headers: pkg-config files, and by `cpack` the Debian package liblacuna-dev.

# lacuna.pc, and lacuna-<component>.pc of each component that was found; they find their folder from their own place.
foreach(component IN ITEMS lacuna ${lacuna_built_components})
  set(pc_suffix "")
  set(pc_what "${PROJECT_DESCRIPTION}")
  set(pc_requires "eigen3 >= 3.4, nanoflann >= 1.4")
  set(pc_cflags "-I\${includedir}")
  set(pc_libs "")
  if(NOT component STREQUAL "lacuna")
    set(pc_suffix "-${component}")
    set(pc_what "${LACUNA_${component}_WHAT}")
    list(JOIN LACUNA_${component}_PC_REQUIRES ", " pc_requires)
    string(PREPEND pc_requires "lacuna = ${PROJECT_VERSION}, ")
    string(REGEX REPLACE ", $" "" pc_requires "${pc_requires}")
    set(pc_cflags "${LACUNA_${component}_PC_FLAGS}")
    set(pc_libs "${LACUNA_${component}_PC_FLAGS}")
  endif()
  configure_file("${CMAKE_CURRENT_LIST_DIR}/lacuna.pc.in" "${CMAKE_CURRENT_BINARY_DIR}/lacuna${pc_suffix}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/lacuna${pc_suffix}.pc" DESTINATION "${CMAKE_INSTALL_DATADIR}/pkgconfig"
    COMPONENT dev)
endforeach()

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lacuna)
set(CPACK_PACKAGE_CONTACT "the Lacuna authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
# The library alone: programs of this build are for this machine.
set(CPACK_COMPONENTS_ALL dev)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME liblacuna-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEV_DESCRIPTION "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libnanoflann-dev (>= 1.4)")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "libqhull-dev, libcairo2-dev, libcereal-dev, zlib1g-dev")
include(CPack)
