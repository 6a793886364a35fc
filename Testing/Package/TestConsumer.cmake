# SPDX-License-Identifier: BSD-3-Clause
set(installed "${WORK_DIR}/installed")
set(moved "${WORK_DIR}/moved")
set(build "${WORK_DIR}/build")
file(REMOVE_RECURSE "${installed}" "${moved}" "${build}")

function (run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if (NOT result EQUAL 0)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif ()
endfunction ()

run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${installed}" --config "${CONFIGURATION}")
file(RENAME "${installed}" "${moved}")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${CONSUMER_DIR}" -B "${build}"
  "-DCMAKE_PREFIX_PATH=${moved}" "-DCMAKE_BUILD_TYPE=${CONFIGURATION}"
  "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" "-DCMAKE_C_COMPILER=${C_COMPILER}"
  "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}")
run("${CMAKE_COMMAND}" --build "${build}" --config "${CONFIGURATION}")
run("${CMAKE_CTEST_COMMAND}" --test-dir "${build}" --build-config "${CONFIGURATION}"
  --output-on-failure)
