// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BenchmarkTetrahedralizer.cxx
 * @brief User CPU time and peak memory of the tetrahedralizer beside those of other programs.
 *
 * Usage: BenchmarkTetrahedralizer [-n points]... [-r repetitions] [-i input]... [-p program]...
 *                                 [-t threads] [--limit seconds]
 *        BenchmarkTetrahedralizer --run program -i input -n points [--mesh name]
 *        BenchmarkTetrahedralizer --list programs
 *
 * Every measurement runs in a process of its own; the programs take turns, so that what else the
 * machine does falls on all of them. Prints the median of each, and ratios to ours. A program that
 * took longer than the limit (100 s) is not repeated, and ended when it takes twice that. It is
 * left out where its time, if it only grew with the number of points, would be above the limit.
 *
 * With several threads there is a row for as many copies with one thread each at the same time,
 * too: what they lose is lost to the machine, and no number of threads can win it back.
 *
 * --run: a single measurement, in this process, for Suite.py; one line of "name value" pairs. Its
 * mesh goes to name.node and name.ele, the files of TetGen.
 * --list programs: those that there are, one on each line, with the version where it is known.
 */
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "Measurement.h"
#include "TetgenFiles.h"

#ifdef CDM_HAS_CGAL_TRIANGULATION
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>
#endif
#ifdef CDM_HAS_TETGEN
#include <tetgen.h>
#endif
#ifdef CDM_HAS_VTK_DELAUNAY3D
#include <vtkDelaunay3D.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace
{
using cdm::Vec3;
using PointSet = std::vector<Vec3>;

PointSet MakeGrid(std::size_t count, const std::function<Vec3(const Vec3&)>& place)
{
  const int side = static_cast<int>(std::lround(std::cbrt(static_cast<double>(count))));
  PointSet points;
  for (int i = 0; i < side; ++i)
  {
    for (int j = 0; j < side; ++j)
    {
      for (int k = 0; k < side; ++k)
      {
        points.push_back(place({ double(i), double(j), double(k) }));
      }
    }
  }
  return points;
}

PointSet MakePoints(const std::string& input, std::size_t count)
{
  std::mt19937_64 generator(1);
  // Not the distributions of the standard library, which differ from one to the next.
  const auto uniform = [&generator]() { return std::ldexp(double(generator() >> 11), -53); };
  const auto normal = [&uniform]()
  { return std::sqrt(-2.0 * std::log(1.0 - uniform())) * std::cos(6.283185307179586 * uniform()); };
  const auto inCube = [&uniform]()
  {
    const double x = uniform();
    const double y = uniform();
    return Vec3{ x, y, uniform() };
  };
  PointSet points;
  if (input == "random")
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      points.push_back(inCube());
    }
  }
  else if (input == "graded")
  {
    // Distances grow by 1:1000 from one corner of a pyramid to its base.
    for (std::size_t i = 0; i < count; ++i)
    {
      const Vec3 p = inCube();
      const double scale = std::pow(1000.0, p.X - 1.0);
      points.push_back({ scale, p.Y * scale, p.Z * scale });
    }
  }
  else if (input == "sphere")
  {
    // Nine of ten points on the sphere, as far as rounding allows; one within.
    for (std::size_t i = 0; i < count; ++i)
    {
      const double x = normal();
      const double y = normal();
      const Vec3 p{ x, y, normal() };
      const double radius = i % 10 == 0 ? std::cbrt(uniform()) : 1.0;
      points.push_back((radius / Norm(p)) * p);
    }
  }
  else if (input == "clusters")
  {
    PointSet centers;
    for (int i = 0; i < 100; ++i)
    {
      centers.push_back(inCube());
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      const double x = normal();
      const double y = normal();
      points.push_back(centers[i % centers.size()] + 0.003 * Vec3{ x, y, normal() });
    }
  }
  else if (input == "grid")
  {
    points = MakeGrid(count, [](const Vec3& p) { return p; });
  }
  else if (input == "grid0.1")
  {
    points = MakeGrid(count, [](const Vec3& p) { return 0.1 * p; });
  }
  else if (input == "rotated")
  {
    // By 10 degrees about (1, 2, 3).
    const Vec3 axis = (1.0 / std::sqrt(14.0)) * Vec3{ 1.0, 2.0, 3.0 };
    const double angle = 10.0 * 0.017453292519943295;
    points = MakeGrid(count,
      [&](const Vec3& p)
      {
        return std::cos(angle) * p + std::sin(angle) * Cross(axis, p) +
          (1.0 - std::cos(angle)) * Dot(axis, p) * axis;
      });
  }
  for (std::size_t i = points.size(); i > 1; --i)
  {
    std::swap(points[i - 1], points[generator() % i]);
  }
  return points;
}

/**
 * A program converts the points, starts the clock, meshes, and stops it. Then it gives its result
 * to mesh, unless that is null.
 */
using Program = std::function<void(const PointSet&, Clock& clock, TetgenMesh* mesh)>;

Measurement MeasureProgram(
  const std::string& input, std::size_t count, const Program& program, int copies, double limit)
{
  const Work work = [&](Clock& clock)
  {
    const PointSet points = MakePoints(input, count);
    const rlim_t seconds = static_cast<rlim_t>(std::ceil(GetUserTime() + 2.0 * limit));
    const rlimit bound{ seconds, seconds };
    setrlimit(RLIMIT_CPU, &bound);
    program(points, clock, nullptr);
  };
  return Measure(work, copies);
}

/** What a program has made. */
std::array<double, 2> GetCounts(const PointSet& points, std::size_t tetrahedra)
{
  return { tetrahedra > 0 ? static_cast<double>(points.size()) : 0.0,
    static_cast<double>(tetrahedra) };
}

void RunOurs(const PointSet& points, Clock& clock, int threads, TetgenMesh* mesh)
{
  clock.Start();
  cdm::AdvancingFrontTetrahedralizerInput input;
  input.MeshPoints = &points;
  cdm::AdvancingFrontTetrahedralizerOptions options;
  options.CloseOpenBoundary = true;
  cdm::AdvancingFrontTetrahedralizerOutput output;
  const cdm::Status status =
    cdm::TetrahedralizeByAdvancingFront(input, options, cdm::ExecutionContext(threads), output);
  clock.Stop(GetCounts(points, status.IsOk() ? output.Mesh.Tetrahedra.size() : 0));
  if (mesh)
  {
    mesh->Points.assign(output.Mesh.Points.begin(), output.Mesh.Points.end());
    for (const auto& t : output.Mesh.Tetrahedra)
    {
      mesh->Tetrahedra.push_back(
        { std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2]), std::size_t(t[3]) });
    }
  }
}

#ifdef CDM_HAS_CGAL_TRIANGULATION
void RunCgal(const PointSet& points, Clock& clock, TetgenMesh* mesh)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> converted;
  for (const Vec3& p : points)
  {
    converted.emplace_back(p.X, p.Y, p.Z);
  }
  clock.Start();
  // The constructor sorts the points along a curve.
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;
  const Triangulation triangulation(converted.begin(), converted.end());
  clock.Stop(GetCounts(points, triangulation.number_of_finite_cells()));
  if (mesh)
  {
    std::map<Triangulation::Vertex_handle, std::size_t> numbers;
    for (auto vertex : triangulation.finite_vertex_handles())
    {
      numbers.emplace(vertex, mesh->Points.size());
      const auto& p = vertex->point();
      mesh->Points.push_back({ p.x(), p.y(), p.z() });
    }
    for (auto cell : triangulation.finite_cell_handles())
    {
      mesh->Tetrahedra.push_back({ numbers[cell->vertex(0)], numbers[cell->vertex(1)],
        numbers[cell->vertex(2)], numbers[cell->vertex(3)] });
    }
  }
}
#endif

#ifdef CDM_HAS_TETGEN
void RunTetgen(const PointSet& points, Clock& clock, TetgenMesh* mesh)
{
  tetgenio in;
  tetgenio out;
  in.numberofpoints = static_cast<int>(points.size());
  in.pointlist = new REAL[3 * points.size()];
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    in.pointlist[3 * i] = points[i].X;
    in.pointlist[3 * i + 1] = points[i].Y;
    in.pointlist[3 * i + 2] = points[i].Z;
  }
  clock.Start();
  char switches[] = "Q";
  tetrahedralize(switches, &in, &out);
  clock.Stop(GetCounts(points, static_cast<std::size_t>(out.numberoftetrahedra)));
  if (mesh)
  {
    mesh->Points = points;
    for (int i = 0; i < out.numberoftetrahedra; ++i)
    {
      const int* t = out.tetrahedronlist + 4 * i;
      mesh->Tetrahedra.push_back(
        { std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2]), std::size_t(t[3]) });
    }
  }
}
#endif

#ifdef CDM_HAS_VTK_DELAUNAY3D
void RunVtk(const PointSet& points, Clock& clock, TetgenMesh* mesh)
{
  vtkNew<vtkPoints> converted;
  converted->SetDataTypeToDouble();
  for (const Vec3& p : points)
  {
    converted->InsertNextPoint(p.X, p.Y, p.Z);
  }
  vtkNew<vtkPolyData> input;
  input->SetPoints(converted);
  clock.Start();
  vtkNew<vtkDelaunay3D> delaunay;
  delaunay->SetInputData(input);
  delaunay->Update();
  vtkUnstructuredGrid* output = delaunay->GetOutput();
  clock.Stop(GetCounts(points, static_cast<std::size_t>(output->GetNumberOfCells())));
  if (mesh)
  {
    mesh->Points = points;
    for (vtkIdType i = 0; i < output->GetNumberOfCells(); ++i)
    {
      vtkIdType size;
      const vtkIdType* ids;
      output->GetCellPoints(i, size, ids);
      if (size == 4)
      {
        mesh->Tetrahedra.push_back(
          { std::size_t(ids[0]), std::size_t(ids[1]), std::size_t(ids[2]), std::size_t(ids[3]) });
      }
    }
  }
}
#endif

struct Entry
{
  std::string Name;
  Program Make;
  int Copies = 1;
};

/** The version of a program, where it is known. */
const char* GetVersion(const std::string& name)
{
#ifdef CDM_HAS_CGAL_TRIANGULATION
  if (name == "CGAL")
  {
    return CGAL_VERSION_STR;
  }
#endif
  return "";
}

/** The exit status. */
int RunSingle(const std::vector<Entry>& programs, const std::string& name, const std::string& input,
  std::size_t count, const std::string& meshName)
{
  const auto program = std::find_if(
    programs.begin(), programs.end(), [&name](const Entry& entry) { return entry.Name == name; });
  if (program == programs.end())
  {
    std::fprintf(stderr, "there is no program %s here\n", name.c_str());
    return 2;
  }
  const PointSet points = MakePoints(input, count);
  Clock clock;
  TetgenMesh mesh;
  program->Make(points, clock, meshName.empty() ? nullptr : &mesh);
  std::printf("points %zu seconds %g wall %g megabytes %g tetrahedra %.0f\n", points.size(),
    clock.Measured.ProcessorSeconds, clock.Measured.WallSeconds, clock.Measured.Megabytes,
    clock.Measured.Counts[1]);
  if (!meshName.empty())
  {
    WriteTetgenFiles(mesh, meshName);
  }
  return clock.Measured.Counts[1] > 0.0 ? 0 : 1;
}
} // namespace

int main(int argc, char* argv[])
{
  std::vector<std::size_t> sizes;
  std::vector<std::string> inputs;
  std::vector<std::string> chosen;
  std::string single;
  std::string meshName;
  bool isList = false;
  int repetitions = 5;
  int threads = 1;
  double limit = 100.0;
  for (int i = 1; i < argc; i += 2)
  {
    const std::string option = argv[i];
    const char* const value = i + 1 < argc ? argv[i + 1] : "";
    if (option == "-n")
    {
      sizes.push_back(static_cast<std::size_t>(std::atof(value)));
    }
    else if (option == "-r")
    {
      repetitions = std::atoi(value);
    }
    else if (option == "-t")
    {
      threads = std::atoi(value);
    }
    else if (option == "-i")
    {
      inputs.push_back(value);
    }
    else if (option == "-p")
    {
      chosen.push_back(value);
    }
    else if (option == "--limit")
    {
      limit = std::atof(value);
    }
    else if (option == "--run")
    {
      single = value;
    }
    else if (option == "--mesh")
    {
      meshName = value;
    }
    else if (option == "--list")
    {
      isList = true;
    }
    else
    {
      std::fprintf(stderr, "Unknown option %s: see the top of the source.\n", argv[i]);
      return 1;
    }
  }
  if (sizes.empty())
  {
    sizes = { 10000, 100000, 1000000 };
  }
  if (inputs.empty())
  {
    inputs = { "random", "graded", "sphere", "clusters", "grid", "grid0.1", "rotated" };
  }
  const auto makeOurs = [](int threads) -> Program
  {
    return [threads](const PointSet& points, Clock& clock, TetgenMesh* mesh)
    { RunOurs(points, clock, threads, mesh); };
  };
  std::vector<Entry> programs{ { "ours", makeOurs(1) } };
  if (threads > 1)
  {
    const std::string number = std::to_string(threads);
    programs.push_back({ "ours, " + number + " threads", makeOurs(threads) });
    programs.push_back({ "ours, " + number + " copies", makeOurs(1), threads });
  }
  const std::size_t own = programs.size();
#ifdef CDM_HAS_CGAL_TRIANGULATION
  programs.push_back({ "CGAL", RunCgal });
#endif
#ifdef CDM_HAS_TETGEN
  programs.push_back({ "TetGen", RunTetgen });
#endif
#ifdef CDM_HAS_VTK_DELAUNAY3D
  programs.push_back({ "vtkDelaunay3D", RunVtk });
#endif
  if (isList)
  {
    for (const Entry& program : programs)
    {
      std::printf("%s %s\n", program.Name.c_str(), GetVersion(program.Name));
    }
    return 0;
  }
  if (!single.empty())
  {
    return RunSingle(programs, single, inputs.front(), sizes.front(), meshName);
  }
  programs.erase(std::remove_if(programs.begin() + static_cast<std::ptrdiff_t>(own), programs.end(),
                   [&chosen](const auto& program)
                   {
                     return !chosen.empty() &&
                       std::find(chosen.begin(), chosen.end(), program.Name) == chosen.end();
                   }),
    programs.end());

  std::printf("| input | points | program | s | ratio to ours | wall s | tetrahedra/s | MB | "
              "B/tetrahedron |\n"
              "|---|---:|---|---:|---:|---:|---:|---:|---:|\n");
  // Seconds for each point, of the largest set so far.
  std::map<std::pair<std::string, std::string>, double> costs;
  for (std::size_t size : sizes)
  {
    for (const std::string& input : inputs)
    {
      std::map<std::string, std::vector<Measurement>> results;
      std::set<std::string> tooSlow;
      for (const Entry& program : programs)
      {
        if (costs[{ program.Name, input }] * static_cast<double>(size) > limit)
        {
          tooSlow.insert(program.Name);
        }
      }
      for (int repetition = 0; repetition < repetitions; ++repetition)
      {
        for (const auto& [name, program, copies] : programs)
        {
          if (tooSlow.count(name) == 0)
          {
            const Measurement result = MeasureProgram(input, size, program, copies, limit);
            results[name].push_back(result);
            const bool isFast = result.Seconds >= 0.0 && result.Seconds <= limit;
            costs[{ name, input }] =
              (isFast ? result.Seconds : 2.0 * limit) / static_cast<double>(size);
            if (!isFast)
            {
              tooSlow.insert(name);
            }
          }
        }
      }
      const double ours = results["ours"].empty() ? -1.0 : GetMedian(results["ours"]).Seconds;
      for (const auto& [name, program, copies] : programs)
      {
        if (results[name].empty())
        {
          continue;
        }
        const Measurement median = GetMedian(results[name]);
        if (median.Seconds < 0.0)
        {
          std::printf("| %s | %zu | %s | fails, or > %g | | | | | |\n", input.c_str(), size,
            name.c_str(), 2.0 * limit);
          continue;
        }
        std::printf("| %s | %zu | %s | %.3f | %.2f | %.3f | %.0f | %.0f | %.0f |\n", input.c_str(),
          size, name.c_str(), median.Seconds, ours > 0.0 ? median.Seconds / ours : 0.0,
          median.WallSeconds, median.Counts[1] / median.Seconds, median.Megabytes,
          median.Megabytes * 1048576.0 / median.Counts[1]);
        std::fflush(stdout);
      }
    }
  }
  return 0;
}
