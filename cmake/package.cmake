# The library for others: find_package(cloud2csg) and cloud2csg::cloud2csg, or pkg-config. All stages are one file there.
get_property(stages GLOBAL PROPERTY cloud2csg_stages)
get_property(stage_libraries GLOBAL PROPERTY cloud2csg_stage_libraries)
list(REMOVE_DUPLICATES stage_libraries)
list(TRANSFORM stages REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)

add_library(cloud2csg_archive STATIC ${objects})
set_target_properties(cloud2csg_archive PROPERTIES OUTPUT_NAME cloud2csg EXPORT_NAME cloud2csg LINKER_LANGUAGE CXX)
target_compile_features(cloud2csg_archive PUBLIC cxx_std_20)
target_include_directories(cloud2csg_archive INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
# Those that our headers include; the others are linked, no more.
target_link_libraries(cloud2csg_archive PUBLIC Eigen3::Eigen Boost::headers PRIVATE ${stage_libraries})
# Programs that link the library find the module with OpenCASCADE by their run paths.
if(TARGET cloud2csg_opencascade)
  target_link_options(cloud2csg_archive INTERFACE
                      $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CLOUD2CSG_INSTALL_MODULEDIR}>)
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/cloud2csg)
install(TARGETS cloud2csg_archive EXPORT cloud2csg-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
                                                                   COMPONENT Development)
# What cmake --install --strip and cpack do to programs, and CMake leaves undone for archives.
install(
  CODE "
  if(CMAKE_INSTALL_DO_STRIP)
    execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug --enable-deterministic-archives
      \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/$<TARGET_FILE_NAME:cloud2csg_archive>\"
      COMMAND_ERROR_IS_FATAL ANY)
  endif()"
  COMPONENT Development)
install(DIRECTORY include/cloud2csg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT Development)
install(EXPORT cloud2csg-targets NAMESPACE cloud2csg:: DESTINATION ${package_folder} COMPONENT Development)

include(CMakePackageConfigHelpers)
write_basic_package_version_file(cloud2csg-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/cloud2csg-config.cmake cmake/dependencies.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/cloud2csg-config-version.cmake DESTINATION ${package_folder}
        COMPONENT Development)

# Paths from the file's own place, so that an installation can be moved.
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
if(TARGET cloud2csg_opencascade)
  set(module_run_path "-Wl,-rpath,\${prefix}/${CLOUD2CSG_INSTALL_MODULEDIR}")
endif()
configure_file(cmake/cloud2csg.pc.in cloud2csg.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cloud2csg.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT Development)
