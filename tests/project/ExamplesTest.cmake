# Installs semloop into a folder of its own and builds doc/examples against it there. Arguments:
# BUILD_DIR, EXAMPLES, WORK_DIR, GENERATOR, CXX_FLAGS.
include(${CMAKE_CURRENT_LIST_DIR}/Run.cmake)

file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
foreach(example color-segmenter coverage-map)
  run(${CMAKE_COMMAND} -S ${EXAMPLES}/${example} -B ${WORK_DIR}/${example} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}")
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/${example})
endforeach()
