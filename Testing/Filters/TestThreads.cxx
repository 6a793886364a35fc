// SPDX-License-Identifier: BSD-3-Clause
// How many threads the filters use: what vtkSMPTools was told, or one for each core.
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkSMPTools.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <thread>

using namespace testing_filters;

#ifdef __linux__
namespace
{
int CountThreads()
{
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<int>(std::distance(begin(tasks), end(tasks)));
}

/** Counts the threads of this process whenever a filter tells its progress. */
class ThreadCounter : public vtkCommand
{
public:
  static ThreadCounter* New() { return new ThreadCounter; }
  void Execute(vtkObject*, unsigned long, void*) override
  {
    this->Most = std::max(this->Most, CountThreads());
  }

  int Most = 0;
};

/** Threads that work in the mesher at the same time. */
int CountThreadsOfMesher()
{
  // Others of this process, if there are any, are not the mesher's.
  const int others = CountThreads() - 1;
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetInputData(MakeTwoBoxes(true));
  mesher->SetMaximumEdgeLength(0.05);
  // Stages that improve tetrahedra have threads that wait meanwhile.
  mesher->SetMeshForToFewestPoints();
  mesher->RemoveSliversOff();
  vtkNew<ThreadCounter> counter;
  mesher->AddObserver(vtkCommand::ProgressEvent, counter);
  mesher->Update();
  return counter->Most - others;
}

class Threads : public testing::Test
{
protected:
  void SetUp() override { this->Forget(); }
  void TearDown() override { this->Forget(); }
  void Forget()
  {
    unsetenv("VTK_SMP_MAX_THREADS");
    unsetenv("VTK_SMP_BACKEND_IN_USE");
    vtkSMPTools::Initialize();
  }
};
} // namespace

TEST_F(Threads, AreOneForEachCore)
{
  EXPECT_EQ(CountThreadsOfMesher(), static_cast<int>(std::thread::hardware_concurrency()));
}

TEST_F(Threads, AreAsManyAsAskedFor)
{
  const bool isSequential = vtkSMPTools::GetBackend() == std::string("Sequential");
  for (const int number : { 1, 2, 3 })
  {
    vtkSMPTools::Initialize(number);
    // Other backends may know a limit of their own.
    const int expected = isSequential ? number : vtkSMPTools::GetEstimatedNumberOfThreads();
    EXPECT_EQ(CountThreadsOfMesher(), expected);
  }
}

TEST_F(Threads, AreAsManyAsTheEnvironmentSays)
{
  setenv("VTK_SMP_MAX_THREADS", "1", 1);
  vtkSMPTools::Initialize();
  EXPECT_EQ(CountThreadsOfMesher(), 1);
}

TEST_F(Threads, AreThoseOfTheBackendInTheEnvironment)
{
  // It was read when the process began.
  setenv("VTK_SMP_BACKEND_IN_USE", vtkSMPTools::GetBackend(), 1);
  EXPECT_EQ(CountThreadsOfMesher(), vtkSMPTools::GetEstimatedNumberOfThreads());
}
#endif
