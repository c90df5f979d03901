# The page of reports (viewer/), built once by Node.js and compiled in. Sets CLOUD2CSG_PAGE_TEMPLATE to the source file
# that holds it, and CLOUD2CSG_HAS_VIEWER. Without Node.js, or without the network that a first `npm ci` takes, reports
# cannot be written, and say so.
set(CLOUD2CSG_VIEWER AUTO CACHE STRING "Build the page of reports: AUTO (where Node.js is), ON, OFF")
set_property(CACHE CLOUD2CSG_VIEWER PROPERTY STRINGS AUTO ON OFF)

set(viewer_folder ${CMAKE_CURRENT_BINARY_DIR}/viewer)
set(CLOUD2CSG_PAGE_TEMPLATE ${CMAKE_CURRENT_BINARY_DIR}/page_template.cpp)
set(CLOUD2CSG_HAS_VIEWER OFF)
if(CLOUD2CSG_VIEWER STREQUAL "AUTO" OR CLOUD2CSG_VIEWER)
  find_program(CLOUD2CSG_NODE NAMES node nodejs)
  find_program(CLOUD2CSG_NPM npm)
  if(CLOUD2CSG_NODE AND CLOUD2CSG_NPM)
    execute_process(COMMAND ${CLOUD2CSG_NODE} --version OUTPUT_VARIABLE node_version OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REGEX REPLACE "^v" "" node_version "${node_version}")
    if(node_version VERSION_GREATER_EQUAL 18)
      set(CLOUD2CSG_HAS_VIEWER ON)
    endif()
  endif()
  if(NOT CLOUD2CSG_HAS_VIEWER)
    set(message "reports (.html) need Node.js 18 or later with npm to be built: found node '${node_version}'")
    if(CLOUD2CSG_VIEWER STREQUAL "AUTO")
      message(STATUS "${message}; building without")
    else()
      message(FATAL_ERROR "${message}")
    endif()
  endif()
endif()

if(CLOUD2CSG_HAS_VIEWER)
  file(GLOB viewer_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/viewer/*.json ${PROJECT_SOURCE_DIR}/viewer/*.html
       ${PROJECT_SOURCE_DIR}/viewer/*.ts)
  file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/viewer/src/*)
  add_custom_command(
    OUTPUT ${CLOUD2CSG_PAGE_TEMPLATE}
    COMMAND
      ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}/viewer -DFOLDER=${viewer_folder}
      -DOUTPUT=${CLOUD2CSG_PAGE_TEMPLATE} -DNODE=${CLOUD2CSG_NODE} -DNPM=${CLOUD2CSG_NPM}
      -DREQUIRED=${CLOUD2CSG_VIEWER} -P ${PROJECT_SOURCE_DIR}/cmake/build_viewer.cmake
    DEPENDS ${viewer_sources} ${page_sources} ${PROJECT_SOURCE_DIR}/cmake/build_viewer.cmake
            ${PROJECT_SOURCE_DIR}/viewer/scripts/embed.mjs
    COMMENT "Building the page of reports"
    VERBATIM)
else()
  file(CONFIGURE OUTPUT ${CLOUD2CSG_PAGE_TEMPLATE} @ONLY CONTENT [[
#include "view/report/page_template.hpp"
std::string_view cloud2csg::page_template() {
  return {};
}
]])
endif()

# For the tests of the page.
set(CLOUD2CSG_HAS_VIEWER ${CLOUD2CSG_HAS_VIEWER} PARENT_SCOPE)
set(CLOUD2CSG_VIEWER_FOLDER ${viewer_folder} PARENT_SCOPE)
