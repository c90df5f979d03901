# Builds the page of SOURCE in FOLDER and writes it to OUTPUT as C++. Where that fails and REQUIRED is AUTO, OUTPUT has
# an empty page, and the rest of the build goes on.
function(run_step what)
  execute_process(
    COMMAND ${ARGN}
    WORKING_DIRECTORY ${FOLDER}
    RESULT_VARIABLE status
    OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(status EQUAL 0)
    return()
  endif()
  if(NOT REQUIRED STREQUAL "AUTO" OR NOT what STREQUAL "npm ci")
    message(FATAL_ERROR "${output}\nThe page of reports could not be built (${what}).")
  endif()
  message(WARNING "${output}\nThe page of reports could not be built (${what}; is the network there?), so this build "
                  "cannot write .html. Delete ${OUTPUT} and build again to try anew.")
  file(WRITE ${OUTPUT} "#include \"view/report/page_template.hpp\"\n"
                       "std::string_view cloud2csg::page_template() {\n  return {};\n}\n")
  set(failed ON PARENT_SCOPE)
endfunction()

# In the build folder, so that several builds of one source do not meet.
file(GLOB top_files ${SOURCE}/*.json ${SOURCE}/*.html ${SOURCE}/*.ts)
file(REMOVE_RECURSE ${FOLDER}/src)
file(COPY ${top_files} ${SOURCE}/src ${SOURCE}/scripts DESTINATION ${FOLDER})

# npm ci starts from nothing each time: only when the packages changed.
file(SHA256 ${FOLDER}/package-lock.json packages)
set(stamp ${FOLDER}/node_modules/installed-${packages})
if(NOT EXISTS ${stamp})
  run_step("npm ci" ${NPM} ci --prefer-offline --no-audit --no-fund --ignore-scripts)
  if(failed)
    return()
  endif()
  file(TOUCH ${stamp})
endif()
run_step("npm run build" ${NPM} run build)
run_step("embed" ${NODE} scripts/embed.mjs dist/index.html ${OUTPUT})
