# cloud2csg_sources(VARIABLE folder): the sources of a folder, as found when building. Several are compiled as one
# (CMAKE_UNITY_BUILD, see the presets), but those that include themselves once for every instruction set.
function(cloud2csg_sources variable folder)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  foreach(source IN LISTS sources)
    file(STRINGS ${source} for_each_target REGEX "define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(for_each_target)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# cloud2csg_stage(folder/stage [DEPENDS stages...] [LINK libraries...])
#
# One library target a folder of src/, cloud2csg_<stage>: a stage that includes a header of a stage it does not name
# here does not link. Public headers live in include/cloud2csg/, private ones beside their sources.
# All stages together are installed as one library (cmake/package.cmake).
function(cloud2csg_stage folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "DEPENDS;LINK")
  cloud2csg_sources(sources ${folder})
  get_filename_component(stage ${folder} NAME)
  set(target cloud2csg_${stage})
  add_library(${target} STATIC ${sources})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON LINKER_LANGUAGE CXX)
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
