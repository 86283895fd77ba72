# SPDX-License-Identifier: MIT
# Open CASCADE reads STEP files, where it is there (Debian: libocct-data-exchange-dev). Its programs are built here alone: who links fettle
# needs none of it, and who runs fettle needs its shared libraries for STEP files only. Sets FETTLE_WITH_STEP; fettle_occt is what to link.
set(FETTLE_STEP AUTO CACHE STRING "Read STEP files by Open CASCADE: AUTO (where it is there), ON (it must be there) or OFF")
set_property(CACHE FETTLE_STEP PROPERTY STRINGS AUTO ON OFF)
set(FETTLE_WITH_STEP OFF)
if(NOT FETTLE_STEP STREQUAL "OFF")
  find_path(OCCT_INCLUDE_DIR STEPCAFControl_Reader.hxx PATH_SUFFIXES opencascade)
  mark_as_advanced(OCCT_INCLUDE_DIR)
  set(occt_libraries "")
  # Files and assemblies, meshes, shapes and geometry; each stands before those that it calls.
  foreach(library TKXDESTEP TKSTEP TKSTEPAttr TKSTEP209 TKSTEPBase TKXSBase TKXCAF TKVCAF TKCAF TKLCAF TKCDF TKMesh TKShHealing TKTopAlgo
      TKPrim TKBO TKBool TKFillet TKGeomAlgo TKBRep TKGeomBase TKG3d TKG2d TKMath TKernel)
    find_library(OCCT_${library} ${library})
    mark_as_advanced(OCCT_${library})
    list(APPEND occt_libraries "${OCCT_${library}}")
  endforeach()
  if(OCCT_INCLUDE_DIR AND NOT occt_libraries MATCHES "NOTFOUND")
    set(FETTLE_WITH_STEP ON)
    add_library(fettle_occt INTERFACE)
    target_include_directories(fettle_occt SYSTEM INTERFACE "${OCCT_INCLUDE_DIR}")
    target_link_libraries(fettle_occt INTERFACE -Wl,--as-needed ${occt_libraries})
  elseif(FETTLE_STEP STREQUAL "ON")
    message(FATAL_ERROR "fettle: FETTLE_STEP is ON and Open CASCADE is not there: sudo apt-get install libocct-data-exchange-dev")
  else()
    message(STATUS "fettle: no Open CASCADE (libocct-data-exchange-dev): STEP files are not read")
  endif()
endif()
