# Builds rawlog-simulate as on a machine without Embree: it says what to install.
# Arguments: SOURCE_DIR, WORK_DIR, GENERATOR.
include(${CMAKE_CURRENT_LIST_DIR}/Run.cmake)

run(${CMAKE_COMMAND} --fresh -S ${SOURCE_DIR} -B ${WORK_DIR} -G ${GENERATOR}
  -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DSEMLOOP_BUILD_TESTS=OFF -DSEMLOOP_BUILD_BENCHMARKS=OFF)
run(${CMAKE_COMMAND} --build ${WORK_DIR} --target rawlog-simulate)

execute_process(COMMAND ${WORK_DIR}/bin/rawlog-simulate scene.ini room.rawlog
  OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
if(NOT result EQUAL 1)
  message(FATAL_ERROR "ended with ${result}:\n${output}")
endif()
if(NOT output MATCHES "^rawlog-simulate: [^\n]*install libembree-dev[^\n]*\n$")
  message(FATAL_ERROR "not one line that says what to install:\n${output}")
endif()
