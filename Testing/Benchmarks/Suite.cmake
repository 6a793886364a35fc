# SPDX-License-Identifier: BSD-3-Clause
# The commands behind Suite.py; see Suite.md.
add_executable(SuiteMeasure SuiteMeasure.cxx)
add_executable(SuiteMesher SuiteMesher.cxx)
target_link_libraries(SuiteMesher PRIVATE ConformingDelaunay::Meshing VTK::CommonCore
  VTK::CommonDataModel VTK::CommonExecutionModel VTK::IOXML)
if (CONFORMINGDELAUNAY_WRAP_PYTHON)
  # Its short form: it ends with an error if one of our results is not what it should be.
  add_test(NAME bench.Suite
    COMMAND "${with_display}" "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Suite.py" run
      --programs "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}"
      --output "${CMAKE_CURRENT_BINARY_DIR}/Suite"
      --quick --repetitions 1 --limit 10)
  set_tests_properties(bench.Suite PROPERTIES
    LABELS bench TIMEOUT 600 RUN_SERIAL ON ENVIRONMENT "${test_environment}")
endif ()
