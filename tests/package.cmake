# The installation: the program as a .deb, the library in another project, where it does not bring sanitizers or coverage.
if(CLOUD2CSG_SANITIZERS OR CMAKE_CXX_FLAGS_DEBUG MATCHES "--coverage")
  return()
endif()
set(model ${PROJECT_SOURCE_DIR}/data/models/m0.json)
add_test(
  NAME package.embed
  COMMAND
    ${CMAKE_CURRENT_SOURCE_DIR}/package/embed_test.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}/examples/embed
    ${model} -G ${CMAKE_GENERATOR} -D CMAKE_C_COMPILER=${CMAKE_C_COMPILER} -D CMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER})
set_tests_properties(package.embed PROPERTIES ENVIRONMENT CXX=${CMAKE_CXX_COMPILER})
set(package_tests package.embed)

find_program(CLOUD2CSG_SHLIBDEPS dpkg-shlibdeps)
if(CLOUD2CSG_SHLIBDEPS)
  add_test(NAME package.deb COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/package/deb_test.sh ${PROJECT_BINARY_DIR} ${model})
  list(APPEND package_tests package.deb)
endif()
set_tests_properties(${package_tests} PROPERTIES LABELS "external;package" TIMEOUT 900)
