// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelTesting.h
 * @brief What the tests on several processes share: the main program, and meshes as sets that do
 * not depend on who has what.
 *
 * All processes run the same tests. Those of one process alone (expected results, small enough for
 * each) must not throw or leave a test while the others wait: expectations, not assertions.
 */
#ifndef ParallelTesting_h
#define ParallelTesting_h

#include "FilterTesting.h"

#include <vtkMPIController.h>
#include <vtkMultiProcessController.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <vector>

namespace testing_parallel
{
inline int GetRank()
{
  return vtkMultiProcessController::GetGlobalController()->GetLocalProcessId();
}

inline int GetSize()
{
  return vtkMultiProcessController::GetGlobalController()->GetNumberOfProcesses();
}

inline long long Sum(long long own)
{
  long long sum = 0;
  vtkMultiProcessController::GetGlobalController()->AllReduce(
    &own, &sum, 1, vtkCommunicator::SUM_OP);
  return sum;
}

/** A cell: the coordinates of its N points in ascending order, then up to two regions. */
template <std::size_t N>
using CellKey = std::array<double, 3 * N + 2>;

template <std::size_t N>
CellKey<N> MakeKey(vtkDataSet* data, vtkIdType cell, const char* regionName)
{
  std::array<std::array<double, 3>, N> points;
  vtkNew<vtkIdList> ids;
  data->GetCellPoints(cell, ids);
  EXPECT_EQ(ids->GetNumberOfIds(), static_cast<vtkIdType>(N));
  for (std::size_t i = 0; i < N; ++i)
  {
    data->GetPoint(ids->GetId(static_cast<vtkIdType>(i)), points[i].data());
  }
  std::sort(points.begin(), points.end());
  CellKey<N> key{};
  for (std::size_t i = 0; i < N; ++i)
  {
    std::copy(points[i].begin(), points[i].end(), key.begin() + 3 * i);
  }
  vtkDataArray* regions = data->GetCellData()->GetArray(regionName);
  EXPECT_NE(regions, nullptr);
  for (int i = 0; regions && i < regions->GetNumberOfComponents(); ++i)
  {
    key[3 * N + static_cast<std::size_t>(i)] = regions->GetComponent(cell, i);
  }
  return key;
}

/** The cells of a data set that are no ghosts, or those that are, ascending. */
template <std::size_t N>
std::vector<CellKey<N>> GetCells(vtkDataSet* data, const char* regionName, bool areGhosts = false)
{
  vtkUnsignedCharArray* ghosts = data->GetCellGhostArray();
  std::vector<CellKey<N>> cells;
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    if ((ghosts && ghosts->GetValue(cell) != 0) == areGhosts)
    {
      cells.push_back(MakeKey<N>(data, cell, regionName));
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/** The keys of all processes, on all processes. */
template <typename Key>
std::vector<Key> GatherCells(const std::vector<Key>& own)
{
  auto controller = vtkMultiProcessController::GetGlobalController();
  const std::size_t width = std::tuple_size<Key>::value;
  const vtkIdType length = static_cast<vtkIdType>(width * own.size());
  std::vector<vtkIdType> lengths(static_cast<std::size_t>(GetSize()));
  controller->AllGather(&length, lengths.data(), 1);
  std::vector<vtkIdType> offsets(1, 0);
  for (vtkIdType other : lengths)
  {
    offsets.push_back(offsets.back() + other);
  }
  std::vector<Key> all(static_cast<std::size_t>(offsets.back()) / width + 1);
  controller->AllGatherV(own.empty() ? nullptr : own.front().data(), all.front().data(), length,
    lengths.data(), offsets.data());
  all.pop_back();
  std::sort(all.begin(), all.end());
  return all;
}

inline int RunAllTests(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testing::InitGoogleTest(&argc, argv);
  const int own = RUN_ALL_TESTS();
  int worst = 0;
  controller->AllReduce(&own, &worst, 1, vtkCommunicator::MAX_OP);
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return worst;
}
} // namespace testing_parallel

#endif
