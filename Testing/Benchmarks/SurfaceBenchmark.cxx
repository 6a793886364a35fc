// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceBenchmark.cxx
 * @brief Measures the stages of the engine on one model or on a surface made here.
 *
 *     SurfaceBenchmark model FILE.vtp [CRITERION [ACCURACY_ANGLE [RESOLVE [SMESH]]]]
 *     SurfaceBenchmark torus TRIANGLES NOISE [TETRAHEDRALIZE]
 *
 * model: cleans, refines and tetrahedralizes the polygons of the file. SMESH: the same polygons
 * with coincident points merged are written there, as TetGen reads them.
 * torus: a torus of about so many triangles, its points moved along the normal by a smooth wave and
 * by a random part (NOISE, as a ratio of the spacing); refined, then refined again: the second time
 * nothing is left to do but the check. TETRAHEDRALIZE: 0 leaves out the stage after it.
 *
 * Prints one line of "name value" pairs; seconds are processor time, without reading and writing.
 * Exit status: 0 done, 1 refused (the reason on the standard error), 2 wrong use.
 */
#include "Core/Meshes/PolygonSoup.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <string>

namespace
{
constexpr double Pi = 3.14159265358979323846;

/** Runs a stage and prints its processor time. */
template <typename Stage>
bool Measure(const char* name, Stage&& stage)
{
  const std::clock_t start = std::clock();
  const cdm::Status status = stage();
  std::cout << name << " " << static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC << " "
            << std::flush;
  if (!status.IsOk())
  {
    std::cerr << name << ": " << status.Message << std::endl;
  }
  return status.IsOk();
}

bool ReadPolygons(const char* file, cdm::PolygonSoup& soup)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file);
  reader->Update();
  vtkPolyData* input = reader->GetOutput();
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    double x[3];
    input->GetPoint(i, x);
    soup.Points.push_back({ x[0], x[1], x[2] });
  }
  vtkDataArray* labels = input->GetCellData()->GetArray("BoundaryLabels");
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < input->GetPolys()->GetNumberOfCells(); ++cell)
  {
    input->GetPolys()->GetCellAtId(cell, ids);
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      soup.Connectivity.push_back(static_cast<cdm::Id>(ids->GetId(i)));
    }
    soup.Offsets.push_back(static_cast<cdm::Id>(soup.Connectivity.size()));
    if (labels)
    {
      soup.Labels.push_back({ static_cast<cdm::Id>(labels->GetComponent(cell, 0)),
        static_cast<cdm::Id>(labels->GetComponent(cell, 1)) });
    }
  }
  return soup.GetNumberOfPolygons() > 0;
}

void WriteTetGenInput(const cdm::PolygonSoup& soup, const char* file)
{
  std::map<std::array<double, 3>, cdm::Id> merged;
  std::vector<cdm::Id> newIds;
  std::vector<cdm::Vec3> points;
  for (const cdm::Vec3& p : soup.Points)
  {
    const auto place =
      merged.emplace(std::array<double, 3>{ p.X, p.Y, p.Z }, static_cast<cdm::Id>(points.size()));
    newIds.push_back(place.first->second);
    if (place.second)
    {
      points.push_back(p);
    }
  }
  std::ofstream output(file);
  output << std::setprecision(17) << points.size() << " 3 0 0\n";
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    output << i << " " << points[i].X << " " << points[i].Y << " " << points[i].Z << "\n";
  }
  output << soup.GetNumberOfPolygons() << " 0\n";
  for (cdm::Id polygon = 0; polygon < soup.GetNumberOfPolygons(); ++polygon)
  {
    output << soup.GetPolygonSize(polygon);
    for (cdm::Id i = 0; i < soup.GetPolygonSize(polygon); ++i)
    {
      output << " " << newIds[soup.GetPolygon(polygon)[i]];
    }
    output << "\n";
  }
  output << "0\n0\n";
}

bool Refine(const char* name, const cdm::TriangleMesh& surface,
  const cdm::DelaunaySurfaceRefinerOptions& options, cdm::DelaunaySurfaceRefinerOutput& output)
{
  cdm::DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  return Measure(name, [&] { return cdm::RefineDelaunaySurface(input, options, {}, output); });
}

bool Tetrahedralize(const cdm::TriangleMesh& surface)
{
  cdm::AdvancingFrontTetrahedralizerInput input;
  input.Surface = &surface;
  cdm::AdvancingFrontTetrahedralizerOutput output;
  const bool done = Measure(
    "tetrahedralize", [&] { return cdm::TetrahedralizeByAdvancingFront(input, {}, {}, output); });
  std::cout << "tetrahedra " << output.Mesh.Tetrahedra.size() << " ";
  return done;
}

int RunModel(int argc, char* argv[])
{
  cdm::PolygonSoup soup;
  if (!ReadPolygons(argv[2], soup))
  {
    std::cerr << "no polygons in " << argv[2] << std::endl;
    return 2;
  }
  cdm::BoundaryTriangulatorOptions triangulatorOptions;
  cdm::DelaunaySurfaceRefinerOptions refinerOptions;
  if (argc > 3)
  {
    refinerOptions.Criterion = static_cast<cdm::SurfaceCriterion>(std::atoi(argv[3]));
  }
  if (argc > 4)
  {
    refinerOptions.StructuralEdges.AccuracyAngle = std::atof(argv[4]);
  }
  if (argc > 5)
  {
    triangulatorOptions.ResolveSelfIntersections = std::atoi(argv[5]) != 0;
  }
  if (argc > 6)
  {
    WriteTetGenInput(soup, argv[6]);
  }
  cdm::BoundaryTriangulatorOutput triangulated;
  if (!Measure("triangulate",
        [&] { return cdm::TriangulateBoundary(soup, triangulatorOptions, {}, triangulated); }))
  {
    return 1;
  }
  std::cout << "points " << triangulated.Surface.Points.size() << " triangles "
            << triangulated.Surface.Triangles.size() << " ";
  cdm::DelaunaySurfaceRefinerOutput refined;
  if (!Refine("refine", triangulated.Surface, refinerOptions, refined))
  {
    return 1;
  }
  std::cout << "new " << refined.NewPoints.size() << " unresolved "
            << refined.UnresolvedTriangles.size() << " ";
  return Tetrahedralize(refined.Surface) ? 0 : 1;
}

/** Rows around the tube are shifted by half a spacing: the triangles are about equilateral. */
cdm::TriangleMesh MakeTorus(int numberOfTriangles, double noise)
{
  const double large = 1.0;
  const double small = 0.4;
  const double spacing =
    std::sqrt(4.0 * Pi * Pi * large * small / (0.5 * numberOfTriangles * std::sqrt(0.75)));
  const int columns = static_cast<int>(2.0 * Pi * large / spacing) + 1;
  const int rows = 2 * (static_cast<int>(Pi * small / (spacing * std::sqrt(0.75))) + 1);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> random(-0.5, 0.5);
  cdm::TriangleMesh torus;
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      const double u = 2.0 * Pi * (column + 0.5 * (row % 2)) / columns;
      const double v = 2.0 * Pi * row / rows;
      const double r =
        small + 0.02 * std::sin(5.0 * u) * std::cos(3.0 * v) + noise * spacing * random(generator);
      const double ring = large + r * std::cos(v);
      torus.Points.push_back({ ring * std::cos(u), ring * std::sin(u), r * std::sin(v) });
    }
  }
  for (int row = 0; row < rows; ++row)
  {
    const int below = row * columns;
    const int above = (row + 1) % rows * columns;
    for (int column = 0; column < columns; ++column)
    {
      const int next = (column + 1) % columns;
      const cdm::Id a = below + column;
      const cdm::Id b = below + next;
      const cdm::Id c = above + column;
      const cdm::Id d = above + next;
      if (row % 2 == 0)
      {
        torus.Triangles.push_back({ a, b, c });
        torus.Triangles.push_back({ b, d, c });
      }
      else
      {
        torus.Triangles.push_back({ a, b, d });
        torus.Triangles.push_back({ a, d, c });
      }
    }
  }
  return torus;
}

int RunTorus(int argc, char* argv[])
{
  const cdm::TriangleMesh torus = MakeTorus(std::atoi(argv[2]), std::atof(argv[3]));
  std::cout << "points " << torus.Points.size() << " triangles " << torus.Triangles.size() << " ";
  cdm::DelaunaySurfaceRefinerOutput refined;
  cdm::DelaunaySurfaceRefinerOutput checked;
  if (!Refine("refine", torus, {}, refined) || !Refine("check", refined.Surface, {}, checked))
  {
    return 1;
  }
  std::cout << "new " << refined.NewPoints.size() << " again " << checked.NewPoints.size()
            << " unresolved " << checked.UnresolvedTriangles.size() << " checkedtriangles "
            << refined.Surface.Triangles.size() << " ";
  const bool isToBeFilled = argc < 5 || std::atoi(argv[4]) != 0;
  return !isToBeFilled || Tetrahedralize(checked.Surface) ? 0 : 1;
}
} // namespace

int main(int argc, char* argv[])
{
  const std::string mode = argc > 1 ? argv[1] : "";
  int status = 2;
  if (mode == "model" && argc > 2)
  {
    status = RunModel(argc, argv);
  }
  else if (mode == "torus" && argc > 3)
  {
    status = RunTorus(argc, argv);
  }
  else
  {
    std::cerr << "usage: SurfaceBenchmark model FILE.vtp [CRITERION [ACCURACY_ANGLE [RESOLVE "
                 "[SMESH]]]]\n       SurfaceBenchmark torus TRIANGLES NOISE [TETRAHEDRALIZE]"
              << std::endl;
  }
  std::cout << std::endl;
  return status;
}
