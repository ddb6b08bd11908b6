# SPDX-License-Identifier: BSD-3-Clause
#
# What Lacuna needs and what it can use, written once: the build reads it and so does the installed package.

set(LACUNA_CORE_TARGETS Eigen3::Eigen nanoflann::nanoflann)

# Each optional component: what it is, the package to find, the target to link, and the third-party headers
# by which a header or a source is known to need it (none: never needed, only used when there); what pkg-config requires
# for it, and which flags (none: its headers are where a compiler looks anyway).
set(LACUNA_COMPONENTS pores pictures checkpoints compression openmp)

set(LACUNA_pores_WHAT "triangulations, Qhull's reentrant library")
set(LACUNA_pores_PACKAGE LacunaQhull)
set(LACUNA_pores_TARGET LacunaQhull::qhull_r)
set(LACUNA_pores_HEADERS "^libqhull_r/")
set(LACUNA_pores_PC_REQUIRES qhull_r)

set(LACUNA_pictures_WHAT "pictures, cairo with PNG and SVG")
set(LACUNA_pictures_PACKAGE LacunaCairo)
set(LACUNA_pictures_TARGET LacunaCairo::cairo)
set(LACUNA_pictures_HEADERS "^(cairo/)?cairo(-svg|-features)?\\.h$")
set(LACUNA_pictures_PC_REQUIRES cairo cairo-png cairo-svg)

set(LACUNA_checkpoints_WHAT "checkpoints, cereal")
set(LACUNA_checkpoints_PACKAGE cereal CONFIG)
set(LACUNA_checkpoints_TARGET cereal::cereal)
set(LACUNA_checkpoints_HEADERS "^cereal/")

set(LACUNA_compression_WHAT "compressed VTK files, zlib")
set(LACUNA_compression_PACKAGE ZLIB)
set(LACUNA_compression_TARGET ZLIB::ZLIB)
set(LACUNA_compression_HEADERS "^zlib\\.h$")
set(LACUNA_compression_PC_REQUIRES zlib)

set(LACUNA_openmp_WHAT "loops over several threads, OpenMP")
set(LACUNA_openmp_PACKAGE OpenMP COMPONENTS CXX)
set(LACUNA_openmp_TARGET OpenMP::OpenMP_CXX)
set(LACUNA_openmp_HEADERS "")
set(LACUNA_openmp_PC_FLAGS -fopenmp)

# lacuna_find_core(REQUIRED | QUIET): Eigen and nanoflann. Eigen 3.4's own version file refuses later minor
# versions and ranges, and nanoflann 1.4.3 announces itself as 1.4.2: hence the looks at the versions here.
macro(lacuna_find_core)
  find_package(Eigen3 ${ARGN} CONFIG)
  find_package(nanoflann ${ARGN} CONFIG)
  foreach(lacuna_name Eigen3 nanoflann)
    if(lacuna_name STREQUAL "Eigen3")
      set(lacuna_least 3.4)
    else()
      set(lacuna_least 1.4)
    endif()
    if(${lacuna_name}_FOUND AND ${lacuna_name}_VERSION VERSION_LESS ${lacuna_least})
      message(FATAL_ERROR "lacuna needs ${lacuna_name} ${lacuna_least} or later, found ${${lacuna_name}_VERSION} "
        "in ${${lacuna_name}_DIR}")
    endif()
  endforeach()
endmacro()

# lacuna_find_component(name REQUIRED | QUIET): sets lacuna_<name>_FOUND.
macro(lacuna_find_component component)
  find_package(${LACUNA_${component}_PACKAGE} ${ARGN})
  if(TARGET ${LACUNA_${component}_TARGET})
    set(lacuna_${component}_FOUND TRUE)
  else()
    set(lacuna_${component}_FOUND FALSE)
  endif()
endmacro()
