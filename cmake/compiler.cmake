# Flags shared by every target of the project, kept on one interface target.
add_library(cloud2csg_compiler INTERFACE)
target_compile_features(cloud2csg_compiler INTERFACE cxx_std_20)
target_compile_options(
  cloud2csg_compiler
  INTERFACE -Wall -Wextra -Wshadow -Wconversion
            # One formula gives the same bits in every instruction set: no silent fused multiply-add.
            -ffp-contract=off)
if(CLOUD2CSG_WARNINGS_AS_ERRORS)
  target_compile_options(cloud2csg_compiler INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 reports false positives inside Eigen and the standard library at -O3.
  target_compile_options(cloud2csg_compiler INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds
                                                      -Wno-stringop-overflow -Wno-stringop-overread
                                                      -Wno-restrict)
  # It takes sources that are compiled together (CMAKE_UNITY_BUILD) for headers.
  target_compile_options(cloud2csg_compiler INTERFACE -Wno-subobject-linkage)
endif()
if(CLOUD2CSG_SANITIZERS)
  target_compile_options(cloud2csg_compiler INTERFACE -fsanitize=${CLOUD2CSG_SANITIZERS}
                                                      -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(cloud2csg_compiler INTERFACE -fsanitize=${CLOUD2CSG_SANITIZERS})
  # The standard library checks its indices: undefined behaviour is not looked for in its headers.
  target_compile_definitions(cloud2csg_compiler INTERFACE _GLIBCXX_ASSERTIONS)
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    set(ignorelist ${PROJECT_SOURCE_DIR}/tests/sanitizers.ignore)
    # ccache looks into this file only when told, and finds the entries of other copies of the project only if its path is
    # relative.
    set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_EXTRAFILES=${ignorelist} ${CMAKE_CXX_COMPILER_LAUNCHER})
    if(CMAKE_GENERATOR MATCHES "Ninja")
      file(RELATIVE_PATH ignorelist ${CMAKE_BINARY_DIR} ${ignorelist})
    endif()
    target_compile_options(cloud2csg_compiler INTERFACE -fsanitize-ignorelist=${ignorelist})
  endif()
  # Highway's emulation of vectors takes clang seven minutes for one file with sanitizers. One number at a time instead,
  # as with g++; the real instruction sets stay.
  target_compile_definitions(cloud2csg_compiler INTERFACE HWY_BROKEN_EMU128=1)
endif()
# For sources whose own speed nobody notices: command line, bindings, tests. They take a third less time to compile.
set(CLOUD2CSG_BRIEFLY_OPTIMISED $<$<CONFIG:Release>:-O1>)
# ...and for those of the command line, which with sanitizers take three times as long.
set(CLOUD2CSG_HARDLY_OPTIMISED ${CLOUD2CSG_BRIEFLY_OPTIMISED})
if(CLOUD2CSG_SANITIZERS)
  set(CLOUD2CSG_HARDLY_OPTIMISED -O0)
endif()
