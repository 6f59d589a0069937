# Installs semloop into a folder of its own, builds tests/project/outside against it there, and runs
# what came out, and --help of every installed program. Arguments: BUILD_DIR, SOURCE_DIR, WORK_DIR,
# GENERATOR, CXX_FLAGS, PROGRAMS.
include(${CMAKE_CURRENT_LIST_DIR}/Run.cmake)

file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
set(outside ${WORK_DIR}/outside)

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
file(GLOB_RECURSE config ${prefix}/*/semloop-config.cmake)
if(NOT config)
  message(FATAL_ERROR "no semloop-config.cmake under ${prefix}")
endif()

run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/outside -B ${outside} -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}")
run(${CMAKE_COMMAND} --build ${outside})

# Nothing of the source or build tree may be left in what is installed.
file(GLOB cmake_files ${prefix}/*/cmake/semloop/*.cmake ${prefix}/*/*/cmake/semloop/*.cmake)
foreach(file IN LISTS cmake_files)
  file(READ ${file} text)
  foreach(tree ${BUILD_DIR}/lib ${SOURCE_DIR})
    string(FIND "${text}" ${tree} position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} mentions ${tree}")
    endif()
  endforeach()
endforeach()

run(${outside}/use-semloop ${outside}/liboutside-odometry.so)
message(STATUS "${run_output}")
if(NOT PROGRAMS)
  message(FATAL_ERROR "PROGRAMS: give those that answer --help")
endif()
foreach(program IN LISTS PROGRAMS)
  run(${prefix}/bin/${program} --help)
endforeach()
