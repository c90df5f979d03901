# OpenCASCADE::kernel: OpenCASCADE as far as we use it, when CLOUD2CSG_OPENCASCADE wants it and it is there. Its own
# CMake package asks for all of its libraries, graphics and test harness included, so these are found one by one.
if(NOT CLOUD2CSG_OPENCASCADE MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "CLOUD2CSG_OPENCASCADE is AUTO, ON or OFF, not '${CLOUD2CSG_OPENCASCADE}'")
endif()
if(NOT CLOUD2CSG_OPENCASCADE STREQUAL "OFF")
  find_path(opencascade_include Standard_Version.hxx PATH_SUFFIXES opencascade occt)
  set(missing_opencascade)
  set(opencascade_libraries)
  foreach(
    name IN
    ITEMS TKMesh TKXDESTEP TKSTEP TKSTEPBase TKXSBase TKXCAF TKLCAF TKCDF TKShHealing TKBO TKPrim TKTopAlgo TKGeomAlgo TKBRep
          TKGeomBase TKG3d TKG2d TKMath TKernel)
    find_library(opencascade_${name} ${name})
    if(opencascade_${name})
      list(APPEND opencascade_libraries ${opencascade_${name}})
    else()
      list(APPEND missing_opencascade ${name})
    endif()
  endforeach()
  if(opencascade_include AND NOT missing_opencascade)
    add_library(OpenCASCADE::kernel INTERFACE IMPORTED)
    target_include_directories(OpenCASCADE::kernel SYSTEM INTERFACE ${opencascade_include})
    target_link_libraries(OpenCASCADE::kernel INTERFACE ${opencascade_libraries})
  else()
    if(CLOUD2CSG_OPENCASCADE STREQUAL "ON")
      set(kind FATAL_ERROR)
    else()
      set(kind STATUS)
    endif()
    message(${kind} "OpenCASCADE is not found: no STEP and BREP files "
                    "(install libocct-data-exchange-dev)")
  endif()
endif()
