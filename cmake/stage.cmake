# cloud2csg_stage(NAME stage [DEPENDS stages...] [LINK libraries...])
#
# One library target a folder of src/: a stage that includes a header of a stage it does not name
# here does not link. Public headers live in include/cloud2csg/, private ones beside their sources.
# All stages together are installed as one library (cmake/package.cmake).
function(cloud2csg_stage)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME" "DEPENDS;LINK")
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${arg_NAME}/*.cpp)
  set(target cloud2csg_${arg_NAME})
  add_library(${target} STATIC ${sources})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON LINKER_LANGUAGE CXX)
  cloud2csg_precompile(${target} stage)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  # Third-party headers count as system headers, so that our warnings are about our code.
  target_link_libraries(${target} PUBLIC cloud2csg_compiler Eigen3::Eigen)
  set_property(GLOBAL APPEND PROPERTY cloud2csg_stages ${target})
  set_property(GLOBAL APPEND PROPERTY cloud2csg_stage_libraries ${arg_LINK})
  foreach(stage IN LISTS arg_DEPENDS)
    target_link_libraries(${target} PUBLIC cloud2csg_${stage})
  endforeach()
  target_link_libraries(${target} PRIVATE ${arg_LINK})
endfunction()

# cloud2csg_test(NAME stage [LINK libraries...]): one test program a stage, from tests/<stage>/*.cpp.
function(cloud2csg_test)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME" "LINK")
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${arg_NAME}/*.cpp)
  if(NOT sources)
    return()
  endif()
  set(target test_${arg_NAME})
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE cloud2csg_compiler ${arg_LINK} GTest::gtest_main rapidcheck rapidcheck_gtest)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_options(${target} PRIVATE ${CLOUD2CSG_BRIEFLY_OPTIMISED})
  cloud2csg_precompile(${target} test)
  target_compile_definitions(${target} PRIVATE CLOUD2CSG_DATA_DIR="${PROJECT_SOURCE_DIR}/data")
  gtest_discover_tests(${target} NO_PRETTY_VALUES TEST_PREFIX "${arg_NAME}." DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()
