// SPDX-License-Identifier: BSD-3-Clause
/**
 * Time, memory and traffic of vtkDistributedTetrahedralizer for random points in the unit cube, of
 * which each process makes its share:
 *
 *     mpiexec -n 2 BenchmarkDistributed 1000000
 *
 * Prints the largest value of all processes, sums of tetrahedra and bytes.
 */
#include <vtkDistributedTetrahedralizer.h>

#include <vtkCommunicator.h>
#include <vtkMPIController.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  const int rank = controller->GetLocalProcessId();
  const int size = controller->GetNumberOfProcesses();
  const long long count = static_cast<long long>(argc > 1 ? std::atof(argv[1]) : 1e5);
  vtkNew<vtkPolyData> input;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::mt19937_64 generator(static_cast<unsigned>(rank) + 1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (long long i = count * rank / size; i < count * (rank + 1) / size; ++i)
  {
    const double x = uniform(generator);
    const double y = uniform(generator);
    points->InsertNextPoint(x, y, uniform(generator));
  }
  input->SetPoints(points);
  int result = 0;
  {
    vtkNew<vtkDistributedTetrahedralizer> filter;
    filter->SetInputData(input);
    controller->Barrier();
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t startOfWork = std::clock();
    filter->UpdatePiece(rank, size, 0);
    const double work = static_cast<double>(std::clock() - startOfWork) / CLOCKS_PER_SEC;
    const double time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const double own[5] = { time, work, static_cast<double>(usage.ru_maxrss) / 1024.0,
      static_cast<double>(filter->GetNumberOfHaloPoints()),
      static_cast<double>(filter->GetNumberOfBytesSent()) };
    double largest[5];
    controller->AllReduce(own, largest, 5, vtkCommunicator::MAX_OP);
    const long long cells = filter->GetOutput()->GetNumberOfCells();
    long long allCells = 0;
    controller->AllReduce(&cells, &allCells, 1, vtkCommunicator::SUM_OP);
    if (rank == 0)
    {
      std::printf("| %lld | %d | %lld | %.2f | %.2f | %.0f | %.0f | %.1f | %d |\n", count, size,
        allCells, largest[0], largest[1], largest[2], largest[3], largest[4] / 1e6,
        filter->GetNumberOfRounds());
    }
    result = allCells > 0 ? 0 : 1;
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return result;
}
