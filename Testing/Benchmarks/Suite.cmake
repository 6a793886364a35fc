# SPDX-License-Identifier: BSD-3-Clause
# The commands behind Suite.py; see Suite.md.
add_custom_target(BenchmarkSuite)
add_executable(SuiteMeasure SuiteMeasure.cxx)
add_executable(SuiteMesher SuiteMesher.cxx)
target_link_libraries(SuiteMesher PRIVATE ConformingDelaunay::Meshing VTK::CommonCore
  VTK::CommonDataModel VTK::CommonExecutionModel VTK::IOXML)
add_dependencies(BenchmarkSuite BenchmarkTetrahedralizer SuiteMeasure SuiteMesher)
if (CDM_TETGEN_DIR AND CDM_TETGEN_LIBRARY)
  add_executable(SuiteTetgen SuiteTetgen.cxx)
  target_compile_definitions(SuiteTetgen PRIVATE TETLIBRARY)
  target_include_directories(SuiteTetgen PRIVATE "${CDM_TETGEN_DIR}")
  target_link_libraries(SuiteTetgen PRIVATE ConformingDelaunay::Core "${CDM_TETGEN_LIBRARY}")
  add_dependencies(BenchmarkSuite SuiteTetgen)
endif ()
find_path(CDM_CGAL_MESH_DIR CGAL/Polyhedral_complex_mesh_domain_3.h)
if (CDM_CGAL_MESH_DIR)
  # It takes minutes and 3 GB to compile: only the suite builds it.
  add_executable(SuiteCgal EXCLUDE_FROM_ALL SuiteCgal.cxx)
  target_link_libraries(SuiteCgal PRIVATE ConformingDelaunay::Core ConformingDelaunay::Meshing
    CGAL::CGAL VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel VTK::IOXML)
  add_dependencies(BenchmarkSuite SuiteCgal)
endif ()
if (CONFORMINGDELAUNAY_WRAP_PYTHON)
  add_dependencies(BenchmarkSuite cdmMeshingPython)
  add_test(NAME bench.SuiteMeasure
    COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/TestSuiteMeasure.py"
      $<TARGET_FILE:SuiteMeasure>)
  set_tests_properties(bench.SuiteMeasure PROPERTIES
    LABELS bench TIMEOUT 120 RUN_SERIAL ON ENVIRONMENT "${test_environment}")
  # Its short form: it ends with an error if one of our results is not what it should be.
  add_test(NAME bench.Suite
    COMMAND "${with_display}" "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Suite.py" run
      --programs "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}"
      --output "${CMAKE_CURRENT_BINARY_DIR}/Suite"
      --quick --repetitions 1 --limit 10)
  set_tests_properties(bench.Suite PROPERTIES
    LABELS bench TIMEOUT 600 RUN_SERIAL ON ENVIRONMENT "${test_environment}")
endif ()
