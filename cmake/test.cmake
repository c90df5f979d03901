# cloud2csg_test(stage [THREADS] [SLOW tests...] [EXTERNAL tests...] [LINK stages and libraries...])
#
# One test program a stage, from tests/<stage>/*.cpp. Its tests have labels:
#   slow      takes seconds, or a minute with sanitizers: left out with them. Fast tests of other stages run the same code.
#   external  needs a program that is not ours (OpenSCAD, FreeCAD, a browser, Python, gnuplot): run once, in release
#   fast      all others
#   threads   besides: works on several threads, or is stopped while it does; what the thread sanitizer is for. THREADS says that the
#             stage has such tests; their names tell of threads, stops, interruptions or progress.
# SLOW and EXTERNAL have suites, or tests as in Suite.Test.
function(cloud2csg_test stage)
  cmake_parse_arguments(PARSE_ARGV 1 arg "THREADS" "" "SLOW;EXTERNAL;LINK")
  cloud2csg_sources(sources ${stage})
  set(target test_${stage})
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE cloud2csg_compiler ${arg_LINK} GTest::gtest_main rapidcheck rapidcheck_gtest)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_options(${target} PRIVATE ${CLOUD2CSG_BRIEFLY_OPTIMISED})
  target_compile_definitions(${target} PRIVATE CLOUD2CSG_DATA_DIR="${PROJECT_SOURCE_DIR}/data")
  if(arg_THREADS)
    add_dependencies(tests_of_threads ${target})
  endif()
  if(CLOUD2CSG_SANITIZERS)
    cloud2csg_tests_by_label(${stage} ${arg_THREADS} SLOW ${arg_SLOW} EXTERNAL ${arg_EXTERNAL})
    return()
  endif()
  gtest_discover_tests(${target} NO_PRETTY_VALUES TEST_PREFIX "${stage}." DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
  file(
    WRITE ${CMAKE_CURRENT_BINARY_DIR}/${target}_labels.cmake
    "include(${PROJECT_SOURCE_DIR}/cmake/label_tests.cmake)\n"
    "cloud2csg_label_tests(${stage} ${arg_THREADS} \"\${${target}_TESTS}\" SLOW ${arg_SLOW} EXTERNAL ${arg_EXTERNAL})\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${target}_labels.cmake)
endfunction()

# With sanitizers a process takes longer to start than most tests take: all tests of a label are two entries of ctest,
# which share the tests. Programs of many sources begin first, so that both cores have work until the end.
function(cloud2csg_tests_by_label stage threads)
  cmake_parse_arguments(arg "" "" "SLOW;EXTERNAL" ${ARGN})
  foreach(label SLOW EXTERNAL)
    set(filter)
    foreach(name IN LISTS arg_${label})
      if(name MATCHES "\\.")
        list(APPEND filter ${name} ${name}/* */${name}/*)
      else()
        list(APPEND filter ${name}.* */${name}.*)
      endif()
    endforeach()
    list(JOIN filter ":" ${label})
  endforeach()
  get_target_property(cost test_${stage} SOURCES)
  list(LENGTH cost cost)
  set(fast "-${SLOW}:${EXTERNAL}")
  if(threads)
    set(THREADS "*Thread*:*thread*:*Stop*:*Interrupt*:*Progress*${fast}")
  endif()
  foreach(label fast SLOW EXTERNAL THREADS)
    if(${label})
      string(TOLOWER ${label} name)
      foreach(shard RANGE 1)
        set(entry ${stage}.${name}.${shard})
        add_test(NAME ${entry} COMMAND test_${stage} --gtest_brief=1 --gtest_filter=${${label}})
        set_tests_properties(${entry} PROPERTIES LABELS ${name} TIMEOUT 1800 COST ${cost}
                                                 ENVIRONMENT "GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${shard}")
      endforeach()
    endif()
  endforeach()
endfunction()
