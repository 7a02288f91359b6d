# Installs the runtime into a folder of the test's own, builds two users and the sample froth_minimal against it, runs
# them. With the tool (TOOL not empty) the sample draws a foam, and the picture is that of the sample in the build tree.
#   cmake -D BUILD_DIR= -D SOURCE_DIR= -D WORK_DIR= -D C_COMPILER= -D CXX_COMPILER= -D FLAGS= -D TOOL= -D MINIMAL=
#     -P install_test.cmake
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --component froth_runtime --prefix ${WORK_DIR}/prefix)
function(build_user source build)
  run(${CMAKE_COMMAND} -S ${source} -B ${build}
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
    -D CMAKE_C_COMPILER=${C_COMPILER} -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
    "-DCMAKE_C_FLAGS=${FLAGS}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
  run(${CMAKE_COMMAND} --build ${build})
endfunction()

build_user(${SOURCE_DIR}/tests/install/users ${WORK_DIR}/users)
run(${WORK_DIR}/users/user_c)
run(${WORK_DIR}/users/user_cxx)
build_user(${SOURCE_DIR}/samples/minimal ${WORK_DIR}/minimal)
if(TOOL)
  set(scene ${WORK_DIR}/random.froth)
  file(WRITE ${WORK_DIR}/cameras.json [==[{"views": [{"width": 480, "height": 320, "fx": 480, "fy": 480, "cx": 240, "cy": 160,
    "world_from_camera": [[1, 0, 0, 0.1], [0, 1, 0, -0.2], [0, 0, 1, -2.5]]}]}]==])
  run(${TOOL} synth random --cells 60 -o ${WORK_DIR}/random.pt)
  run(${TOOL} bake ${WORK_DIR}/random.pt -o ${scene} --cameras ${WORK_DIR}/cameras.json)
  run(${WORK_DIR}/minimal/froth_minimal ${scene} ${WORK_DIR}/installed.ppm --frames 2)
  run(${MINIMAL} ${scene} ${WORK_DIR}/built.ppm --frames 2 --compare ${WORK_DIR}/installed.ppm --min-psnr 99)
endif()
