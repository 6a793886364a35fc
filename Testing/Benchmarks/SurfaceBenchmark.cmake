# SPDX-License-Identifier: BSD-3-Clause
# The command behind SurfaceBenchmark.py; see Surface.md.
option(CONFORMINGDELAUNAY_BUILD_SURFACE_BENCHMARK
  "Build the comparison of the surface stage with TetGen (needs VTK's XML reader)" ON)
if (CONFORMINGDELAUNAY_BUILD_SURFACE_BENCHMARK)
  add_executable(SurfaceBenchmark SurfaceBenchmark.cxx)
  target_link_libraries(SurfaceBenchmark PRIVATE ConformingDelaunay::Core VTK::CommonCore
    VTK::CommonDataModel VTK::CommonExecutionModel VTK::IOXML)
  # That it runs, no more: what it measures depends on the machine.
  add_test(NAME bench.SurfaceSmoke COMMAND SurfaceBenchmark torus 2000 0.1)
  set_tests_properties(bench.SurfaceSmoke PROPERTIES LABELS bench TIMEOUT 60
    PASS_REGULAR_EXPRESSION "again 0 unresolved 0 .* tetrahedra [1-9]")
endif ()
