# Large headers that most sources read, parsed once: for builds where only time counts. The release build goes without,
# so that it tells when a source misses an #include.
option(CLOUD2CSG_PRECOMPILE_HEADERS "Precompile the headers of Eigen, the standard library and GoogleTest" OFF)

# cloud2csg_precompile(TARGET KIND): lets TARGET use the headers that are precompiled for KIND, stage or test.
function(cloud2csg_precompile target kind)
  if(NOT CLOUD2CSG_PRECOMPILE_HEADERS)
    return()
  endif()
  set(precompiled cloud2csg_precompiled_${kind})
  if(NOT TARGET ${precompiled})
    set(empty ${CMAKE_BINARY_DIR}/${precompiled}.cpp)
    file(TOUCH ${empty})
    add_library(${precompiled} OBJECT ${empty})
    target_link_libraries(${precompiled} PRIVATE cloud2csg_compiler Eigen3::Eigen)
    target_precompile_headers(${precompiled} PRIVATE <Eigen/Dense> <algorithm> <array> <cmath> <functional> <map>
                              <memory> <numeric> <optional> <random> <span> <string> <variant> <vector>)
    if(kind STREQUAL "test")
      target_link_libraries(${precompiled} PRIVATE GTest::gtest rapidcheck rapidcheck_gtest)
      target_precompile_headers(${precompiled} PRIVATE <gtest/gtest.h> <rapidcheck/gtest.h>)
    else()
      set_target_properties(${precompiled} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${precompiled})
endfunction()
