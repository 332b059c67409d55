# Installs the locked packages into the build folder, from npm's cache if possible, and runs the check. ctest
# calls it with SOURCE, WORK, FIXTURE, NPM, NODE.
file(MAKE_DIRECTORY ${WORK})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/check.mjs DESTINATION ${WORK})
execute_process(COMMAND ${NPM} ci --prefer-offline --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "npm ci failed: this test needs the npm registry once")
endif()
execute_process(COMMAND ${NODE} check.mjs ${FIXTURE} ${WORK}
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the check failed")
endif()
