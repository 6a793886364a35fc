// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BenchmarkStages.cxx
 * @brief Time and memory of each filter by itself, with one and with several threads.
 *
 * Usage: BenchmarkStages [-n points] [-r repetitions] [-t threads] [-s stage]...
 *        BenchmarkStages --memory [-n points] [-s stage]...
 *
 * A cube with graded mesh points (1:3) goes through the stages; every measurement runs in a process
 * of its own, and starts when the input of the stage is there. With several threads there is a row
 * for as many copies with one thread each at the same time, which shows what the machine takes
 * (Measurement.h). --memory measures with n and 4 n points: the difference is free of what does not
 * grow. In both the output counts, and what the filter makes on the way.
 */
#include "Measurement.h"

#include "vtkAdvancingFrontTetrahedralizer.h"
#include "vtkBoundaryTriangulator.h"
#include "vtkConformingDelaunayMesher.h"
#include "vtkDelaunayMeshCriteria.h"
#include "vtkDelaunaySurfaceRefiner.h"
#include "vtkMeshPointGenerator.h"
#include "vtkSizingFromSolution.h"
#include "vtkSliverRemover.h"
#include "vtkSteinerPointRefiner.h"
#include "vtkVoronoiControlVolumes.h"

#include <vtkCubeSource.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

namespace
{
/** Edge lengths that make about so many points in the unit cube. */
vtkSmartPointer<vtkImageData> MakeSizing(double numberOfPoints)
{
  constexpr int side = 33;
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(side, side, side);
  image->SetSpacing(1.0 / (side - 1), 1.0 / (side - 1), 1.0 / (side - 1));
  vtkNew<vtkDoubleArray> sizes;
  sizes->SetName("Sizing");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double x[3];
    image->GetPoint(i, x);
    const double distance = std::hypot(x[0] - 0.3, x[1] - 0.2, x[2] - 0.4);
    sizes->InsertNextValue((0.5 + distance) / std::cbrt(numberOfPoints));
  }
  image->GetPointData()->AddArray(sizes);
  return image;
}

/** A detached copy: what made it takes no memory any more. */
template <typename Data>
vtkSmartPointer<Data> Detach(vtkDataObject* data)
{
  auto copy = vtkSmartPointer<Data>::New();
  copy->ShallowCopy(data);
  return copy;
}

vtkSmartPointer<vtkPolyData> MakeSurface()
{
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(cube->GetOutputPort());
  triangulator->Update();
  auto surface = Detach<vtkPolyData>(triangulator->GetOutputDataObject(0));
  // From the center to the origin.
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3];
    surface->GetPoint(i, x);
    surface->GetPoints()->SetPoint(i, x[0] + 0.5, x[1] + 0.5, x[2] + 0.5);
  }
  return surface;
}

/** What the stages take, as far as the one that is measured. */
struct Inputs
{
  vtkSmartPointer<vtkImageData> Sizing;
  vtkSmartPointer<vtkPolyData> Surface;
  vtkSmartPointer<vtkPolyData> Points;
  vtkSmartPointer<vtkUnstructuredGrid> Mesh;

  vtkSmartPointer<vtkMeshPointGenerator> GeneratePoints(int placement) const
  {
    auto generator = vtkSmartPointer<vtkMeshPointGenerator>::New();
    generator->SetInputData(0, this->Surface);
    generator->SetInputData(1, this->Sizing);
    generator->SetPlacement(placement);
    generator->SetMaximumNumberOfPoints(100000000);
    return generator;
  }

  vtkSmartPointer<vtkDelaunaySurfaceRefiner> RefineSurface() const
  {
    auto refiner = vtkSmartPointer<vtkDelaunaySurfaceRefiner>::New();
    refiner->SetInputData(0, this->Surface);
    refiner->SetInputData(1, this->Points);
    refiner->SetInputData(2, this->Sizing);
    return refiner;
  }

  vtkSmartPointer<vtkAdvancingFrontTetrahedralizer> MakeTetrahedra() const
  {
    auto tetrahedralizer = vtkSmartPointer<vtkAdvancingFrontTetrahedralizer>::New();
    tetrahedralizer->SetInputData(0, this->Surface);
    tetrahedralizer->SetInputData(1, this->Points);
    return tetrahedralizer;
  }

  template <typename Filter>
  vtkSmartPointer<Filter> Take() const
  {
    auto filter = vtkSmartPointer<Filter>::New();
    filter->SetInputData(0, this->Mesh);
    return filter;
  }
};

enum class Needs
{
  Surface,
  Points,
  RefinedSurface,
  Tetrahedra
};

Inputs MakeInputs(double numberOfPoints, Needs needs)
{
  Inputs inputs;
  inputs.Sizing = MakeSizing(numberOfPoints);
  inputs.Surface = MakeSurface();
  if (needs >= Needs::Points)
  {
    const auto generator = inputs.GeneratePoints(vtkMeshPointGenerator::OCTREE);
    generator->Update();
    inputs.Points = Detach<vtkPolyData>(generator->GetOutputDataObject(0));
  }
  if (needs >= Needs::RefinedSurface)
  {
    const auto refiner = inputs.RefineSurface();
    refiner->Update();
    inputs.Surface = Detach<vtkPolyData>(refiner->GetOutputDataObject(0));
    inputs.Points = Detach<vtkPolyData>(refiner->GetOutputDataObject(2));
  }
  if (needs >= Needs::Tetrahedra)
  {
    const auto tetrahedralizer = inputs.MakeTetrahedra();
    tetrahedralizer->Update();
    inputs.Mesh = Detach<vtkUnstructuredGrid>(tetrahedralizer->GetOutputDataObject(0));
    inputs.Points = nullptr;
  }
  return inputs;
}

using MakeFilter = std::function<vtkSmartPointer<vtkAlgorithm>(const Inputs&)>;

struct Stage
{
  std::string Name;
  Needs Input;
  MakeFilter Make;
};

std::vector<Stage> MakeStages()
{
  const auto generate = [](int placement) -> MakeFilter
  { return [placement](const Inputs& inputs) { return inputs.GeneratePoints(placement); }; };
  return {
    { "points: octree", Needs::Surface, generate(vtkMeshPointGenerator::OCTREE) },
    { "points: ortho-product", Needs::Surface, generate(vtkMeshPointGenerator::ORTHO_PRODUCT) },
    { "points: random", Needs::Surface, generate(vtkMeshPointGenerator::RANDOM) },
    { "surface refiner", Needs::Points,
      [](const Inputs& inputs) { return inputs.RefineSurface(); } },
    { "tetrahedralizer", Needs::RefinedSurface,
      [](const Inputs& inputs) { return inputs.MakeTetrahedra(); } },
    { "sliver remover", Needs::Tetrahedra,
      [](const Inputs& inputs) { return inputs.Take<vtkSliverRemover>(); } },
    { "Steiner points", Needs::Tetrahedra,
      [](const Inputs& inputs) { return inputs.Take<vtkSteinerPointRefiner>(); } },
    { "criteria", Needs::Tetrahedra,
      [](const Inputs& inputs) { return inputs.Take<vtkDelaunayMeshCriteria>(); } },
    { "control volumes", Needs::Tetrahedra,
      [](const Inputs& inputs) { return inputs.Take<vtkVoronoiControlVolumes>(); } },
    { "sizing from solution", Needs::Tetrahedra,
      [](const Inputs& inputs)
      {
        vtkNew<vtkDoubleArray> solution;
        solution->SetName("Solution");
        for (vtkIdType i = 0; i < inputs.Mesh->GetNumberOfPoints(); ++i)
        {
          double x[3];
          inputs.Mesh->GetPoint(i, x);
          solution->InsertNextValue(std::tanh(20.0 * (x[0] + x[1] - 0.8)));
        }
        inputs.Mesh->GetPointData()->SetScalars(solution);
        auto filter = inputs.Take<vtkSizingFromSolution>();
        filter->SetGradation(0.5);
        return filter;
      } },
    { "all (vtkConformingDelaunayMesher)", Needs::Points,
      [](const Inputs& inputs)
      {
        auto mesher = vtkSmartPointer<vtkConformingDelaunayMesher>::New();
        mesher->SetMeshForToFewestPoints();
        mesher->SetInputData(0, inputs.Surface);
        mesher->SetInputData(1, inputs.Points);
        mesher->SetInputData(2, inputs.Sizing);
        return mesher;
      } },
  };
}

Measurement MeasureStage(const Stage& stage, double numberOfPoints, int threads, int copies)
{
  const Work work = [&](Clock& clock)
  {
    vtkSMPTools::SetBackend("STDThread");
    vtkSMPTools::Initialize(threads);
    vtkSmartPointer<vtkAlgorithm> filter;
    {
      const Inputs inputs = MakeInputs(numberOfPoints, stage.Input);
      filter = stage.Make(inputs);
    }
    clock.Start();
    filter->Update();
    auto output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    auto mesh = vtkUnstructuredGrid::SafeDownCast(
      stage.Input == Needs::Tetrahedra ? filter->GetInputDataObject(0, 0) : output);
    clock.Stop({ static_cast<double>(output->GetNumberOfPoints()),
      mesh ? static_cast<double>(mesh->GetNumberOfCells()) : 0.0 });
  };
  return Measure(work, copies);
}

void PrintMemory(const Stage& stage, double numberOfPoints)
{
  const Measurement few = MeasureStage(stage, numberOfPoints, 1, 1);
  const Measurement many = MeasureStage(stage, 4.0 * numberOfPoints, 1, 1);
  const double bytes = 1048576.0 * (many.AddedMegabytes - few.AddedMegabytes);
  std::printf("| %s | %.0f | %.0f | %.0f |", stage.Name.c_str(), many.Counts[0],
    many.AddedMegabytes, bytes / (many.Counts[0] - few.Counts[0]));
  if (many.Counts[1] > few.Counts[1])
  {
    std::printf(" %.0f", bytes / (many.Counts[1] - few.Counts[1]));
  }
  std::printf(" |\n");
  std::fflush(stdout);
}

void PrintTimes(const Stage& stage, double numberOfPoints, int threads, int repetitions)
{
  struct Row
  {
    std::string Name;
    int Threads;
    int Copies;
    std::vector<Measurement> Results;
  };
  std::vector<Row> rows{ { "1 thread", 1, 1, {} } };
  if (threads > 1)
  {
    rows.push_back({ std::to_string(threads) + " threads", threads, 1, {} });
    rows.push_back({ std::to_string(threads) + " copies", 1, threads, {} });
  }
  for (int repetition = 0; repetition < repetitions; ++repetition)
  {
    for (Row& row : rows)
    {
      row.Results.push_back(MeasureStage(stage, numberOfPoints, row.Threads, row.Copies));
    }
  }
  const double one = GetMedian(rows[0].Results).WallSeconds;
  for (const Row& row : rows)
  {
    const Measurement median = GetMedian(row.Results);
    std::printf("| %s | %.0f | %s | %.3f | %.3f | %.2f |\n", stage.Name.c_str(), median.Counts[0],
      row.Name.c_str(), median.Seconds, median.WallSeconds, row.Copies * one / median.WallSeconds);
    std::fflush(stdout);
  }
}
} // namespace

int main(int argc, char* argv[])
{
  double numberOfPoints = 1e5;
  int repetitions = 3;
  int threads = 2;
  bool isMemory = false;
  std::vector<std::string> chosen;
  for (int i = 1; i < argc; ++i)
  {
    const std::string option = argv[i];
    const char* const value = i + 1 < argc ? argv[i + 1] : "";
    isMemory = isMemory || option == "--memory";
    i += option != "--memory";
    if (option == "-n")
    {
      numberOfPoints = std::atof(value);
    }
    else if (option == "-r")
    {
      repetitions = std::atoi(value);
    }
    else if (option == "-t")
    {
      threads = std::atoi(value);
    }
    else if (option == "-s")
    {
      chosen.push_back(value);
    }
    else if (option != "--memory")
    {
      std::fprintf(stderr,
        "Usage: BenchmarkStages [-n points] [-r repetitions] [-t threads] [-s stage]...\n"
        "       BenchmarkStages --memory [-n points] [-s stage]...\n");
      return 1;
    }
  }
  std::printf(isMemory ? "| stage | points | MB | B/point | B/tetrahedron |\n"
                         "|---|---:|---:|---:|---:|\n"
                       : "| stage | points | | user s | wall s | gain |\n"
                         "|---|---:|---|---:|---:|---:|\n");
  std::fflush(stdout);
  for (const Stage& stage : MakeStages())
  {
    if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), stage.Name) == chosen.end())
    {
      continue;
    }
    if (isMemory)
    {
      PrintMemory(stage, numberOfPoints);
    }
    else
    {
      PrintTimes(stage, numberOfPoints, threads, repetitions);
    }
  }
  return 0;
}
