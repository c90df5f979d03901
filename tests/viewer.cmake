# The page of reports in a headless browser: reports are made by the built program, then looked at.
find_program(CLOUD2CSG_CHROMIUM NAMES chromium chromium-browser google-chrome)
if(NOT CLOUD2CSG_HAS_VIEWER OR NOT CLOUD2CSG_CHROMIUM)
  set(viewer_tests_miss "Node.js and npm")
  if(CLOUD2CSG_HAS_VIEWER)
    set(viewer_tests_miss "chromium")
  endif()
  add_test(NAME viewer.page COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${viewer_tests_miss} not found")
  set_tests_properties(viewer.page PROPERTIES LABELS "external;viewer" SKIP_REGULAR_EXPRESSION "skipped:")
  return()
endif()

set(viewer_reports ${CMAKE_CURRENT_BINARY_DIR}/viewer_reports)
file(MAKE_DIRECTORY ${viewer_reports})
set(model ${PROJECT_SOURCE_DIR}/data/models/m0.json)
add_test(NAME viewer.sample COMMAND cloud2csg sample ${model} -n 60000 --noise 0.01 -o ${viewer_reports}/m0.ply)
add_test(NAME viewer.report COMMAND cloud2csg extract ${viewer_reports}/m0.ply --primitives ${model} -o
                                    ${viewer_reports}/m0.html -o ${viewer_reports}/m0.scad)
add_test(NAME viewer.raw COMMAND cloud2csg extract ${viewer_reports}/m0.ply -o ${viewer_reports}/raw.html)
add_test(NAME viewer.hostile COMMAND cloud2csg convert ${PROJECT_SOURCE_DIR}/viewer/tests/hostile.json -o
                                     ${viewer_reports}/hostile.html)
add_test(NAME viewer.page COMMAND ${CLOUD2CSG_NODE} --test ${PROJECT_SOURCE_DIR}/viewer/tests/report.test.mjs)
set_tests_properties(viewer.sample PROPERTIES FIXTURES_SETUP viewer_cloud)
set_tests_properties(viewer.report viewer.raw PROPERTIES FIXTURES_REQUIRED viewer_cloud FIXTURES_SETUP viewer_reports)
set_tests_properties(viewer.hostile PROPERTIES FIXTURES_SETUP viewer_reports)
set_tests_properties(
  viewer.page
  PROPERTIES FIXTURES_REQUIRED
             viewer_reports
             TIMEOUT
             600
             ENVIRONMENT
             "REPORT=${viewer_reports}/m0.html;RAW=${viewer_reports}/raw.html;HOSTILE=${viewer_reports}/hostile.html;CHROMIUM=${CLOUD2CSG_CHROMIUM};VIEWER_FOLDER=${CLOUD2CSG_VIEWER_FOLDER}"
)
set_tests_properties(viewer.sample viewer.report viewer.raw viewer.hostile viewer.page PROPERTIES LABELS "external;viewer")
