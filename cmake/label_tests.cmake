# Read by ctest, after the tests of a program were discovered: gives each test of STAGE its label.
#   slow      takes seconds: left out with sanitizers
#   external  needs a program that is not ours (OpenSCAD, FreeCAD, a browser, Python, gnuplot): run once, in release
#   fast      all others
#   threads   besides: works on several threads, or is stopped while it does; what the thread sanitizer is for. THREADS says
#             whether the stage has such tests; their names tell of threads, stops, interruptions or progress.
# SLOW and EXTERNAL have suites, or tests as in Suite.Test; one that names nothing is an error.
function(cloud2csg_label_tests stage threads tests)
  cmake_parse_arguments(arg "" "" "SLOW;EXTERNAL" ${ARGN})
  set(unused ${arg_SLOW} ${arg_EXTERNAL})
  foreach(test IN LISTS tests)
    if(test MATCHES "_NOT_BUILT")
      return()
    endif()
    set(labels fast)
    foreach(label SLOW EXTERNAL)
      foreach(name IN LISTS arg_${label})
        string(REPLACE "." "\\." pattern ${name})
        if(test MATCHES "^${stage}\\.(.*/)?${pattern}([./]|$)")
          string(TOLOWER ${label} labels)
          list(REMOVE_ITEM unused ${name})
        endif()
      endforeach()
    endforeach()
    if(threads AND test MATCHES "[Tt]hread|Stop|Interrupt|Progress")
      list(APPEND labels threads)
    endif()
    set_tests_properties(${test} PROPERTIES LABELS "${labels}")
  endforeach()
  if(unused)
    message(FATAL_ERROR "tests/CMakeLists.txt: ${stage} has no tests ${unused}")
  endif()
endfunction()
