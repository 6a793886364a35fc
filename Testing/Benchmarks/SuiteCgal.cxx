// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SuiteCgal.cxx
 * @brief CGAL's Mesh_3 on a file of polygons, measured as SuiteMesher measures ours, for Suite.py.
 *
 *     SuiteCgal EDGE INPUT.vtp OUTPUT
 *
 * The polygons need the cell array BoundaryLabels: the triangles of each pair of regions are a
 * patch of a polyhedral complex, whose sharp edges and borders are kept. EDGE is the largest edge
 * on them; the circumradius of the regular tetrahedron with that edge is the largest one of
 * triangles and tetrahedra. Radius-edge ratio 2 and facet angle 25 degrees, the bounds that CGAL
 * ends for; then its defaults against slivers.
 *
 * Prints one line of "name value" pairs: seconds (processor time without reading and writing),
 * megabytes (the peak until then), start (megabytes before it), points and tetrahedra. The mesh
 * goes to OUTPUT.node and OUTPUT.ele. Exit status: 0 meshed, 1 nothing meshed, 2 wrong use or a file
 * that cannot be read or written.
 */
#include "Measurement.h"
#include "TetgenFiles.h"

#include <vtkBoundaryTriangulator.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_complex_mesh_domain_3.h>
#include <CGAL/make_mesh_3.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <utility>
#include <vector>

namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_complex_mesh_domain_3<Kernel, Polyhedron>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex =
  CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

struct Patch
{
  std::vector<Kernel::Point_3> Points;
  std::vector<std::vector<std::size_t>> Triangles;
};

/** Patches by their regions behind and in front, the order of CGAL; 0 is outside. */
std::map<std::pair<int, int>, Patch> MakePatches(vtkPolyData* surface)
{
  std::map<std::pair<int, int>, Patch> patches;
  std::map<std::pair<int, int>, std::map<vtkIdType, std::size_t>> numbers;
  vtkDataArray* labels = surface->GetCellData()->GetArray("BoundaryLabels");
  for (vtkIdType cell = 0; labels && cell < surface->GetNumberOfCells(); ++cell)
  {
    const std::pair<int, int> regions(static_cast<int>(labels->GetComponent(cell, 1)) + 1,
      static_cast<int>(labels->GetComponent(cell, 0)) + 1);
    Patch& patch = patches[regions];
    vtkIdType size;
    const vtkIdType* ids;
    surface->GetCellPoints(cell, size, ids);
    patch.Triangles.emplace_back();
    for (vtkIdType i = 0; i < size; ++i)
    {
      const auto place = numbers[regions].emplace(ids[i], patch.Points.size());
      if (place.second)
      {
        double x[3];
        surface->GetPoint(ids[i], x);
        patch.Points.emplace_back(x[0], x[1], x[2]);
      }
      patch.Triangles.back().push_back(place.first->second);
    }
  }
  return patches;
}
} // namespace

int main(int argc, char* argv[])
{
  if (argc != 4)
  {
    std::fprintf(stderr, "usage: SuiteCgal EDGE INPUT.vtp OUTPUT\n");
    return 2;
  }
  const double edge = std::atof(argv[1]);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(argv[2]);
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(reader->GetOutputPort());
  triangulator->Update();
  std::map<std::pair<int, int>, Patch> patches = MakePatches(triangulator->GetOutput());
  if (patches.empty())
  {
    return 2;
  }

  const double before = GetMegabytes("VmHWM");
  const std::clock_t start = std::clock();
  std::vector<Polyhedron> polyhedra;
  std::vector<std::pair<int, int>> regions;
  for (auto& [sides, patch] : patches)
  {
    namespace Processing = CGAL::Polygon_mesh_processing;
    Processing::orient_polygon_soup(patch.Points, patch.Triangles);
    polyhedra.emplace_back();
    Processing::polygon_soup_to_polygon_mesh(patch.Points, patch.Triangles, polyhedra.back());
    regions.push_back(sides);
  }
  Domain domain(polyhedra.begin(), polyhedra.end(), regions.begin(), regions.end());
  // Its default of 60 degrees is for smooth shapes; these have all of their edges.
  domain.detect_features(1.0);
  const double radius = std::sqrt(0.375) * edge;
  using namespace CGAL::parameters;
  const Criteria criteria(edge_size = edge, facet_angle = 25.0, facet_size = radius,
    facet_distance = 0.1 * radius, cell_radius_edge_ratio = 2.0, cell_size = radius);
  const Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double megabytes = GetMegabytes("VmHWM");

  TetgenMesh mesh;
  std::map<Complex::Vertex_handle, std::size_t> numbers;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell)
  {
    mesh.Tetrahedra.emplace_back();
    mesh.Marks.push_back(complex.subdomain_index(cell));
    for (int i = 0; i < 4; ++i)
    {
      const auto place = numbers.emplace(cell->vertex(i), mesh.Points.size());
      if (place.second)
      {
        const auto& p = cell->vertex(i)->point();
        mesh.Points.push_back(
          { CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()) });
      }
      mesh.Tetrahedra.back()[i] = place.first->second;
    }
  }
  std::printf("seconds %g megabytes %g start %g points %zu tetrahedra %zu\n", seconds, megabytes,
    before, mesh.Points.size(), mesh.Tetrahedra.size());
  WriteTetgenFiles(mesh, argv[3]);
  return mesh.Tetrahedra.empty() ? 1 : 0;
}
