# Installs the runtime into a folder of the test's own, builds two users against it, runs them.
#   cmake -D BUILD_DIR= -D USER_DIR= -D WORK_DIR= -D C_COMPILER= -D CXX_COMPILER= -D FLAGS= -P install_test.cmake
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --component froth_runtime --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${USER_DIR} -B ${WORK_DIR}/build
  -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
  -D CMAKE_C_COMPILER=${C_COMPILER} -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
  "-DCMAKE_C_FLAGS=${FLAGS}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/user_c)
run(${WORK_DIR}/build/user_cxx)
