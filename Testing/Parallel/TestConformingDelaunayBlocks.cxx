// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelTesting.h"

#include <vtkCompositeDataSet.h>
#include <vtkConformingDelaunayMesher.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>

#include <cmath>

using namespace testing_filters;
using namespace testing_parallel;

namespace
{
vtkSmartPointer<vtkPolyData> MakeBoxAt(double x, double size)
{
  SurfaceBuilder builder;
  builder.AddBox({ x, 0, 0 }, { x + size, size, size });
  return builder.Build();
}

std::vector<vtkSmartPointer<vtkPolyData>> MakeModels()
{
  return { MakeTwoBoxes(true), MakeBoxAt(10, 1), MakeCubeWithCavity(), MakeBoxAt(20, 2),
    MakeCube() };
}

/** Block i on process i mod n only, or all on the last process. */
vtkSmartPointer<vtkDataObjectTree> MakeInput(
  const std::vector<vtkSmartPointer<vtkPolyData>>& models, bool isCollection, bool isSpread = true)
{
  const auto has = [&](std::size_t i)
  { return (isSpread ? static_cast<int>(i) % GetSize() : GetSize() - 1) == GetRank(); };
  if (isCollection)
  {
    auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
    collection->SetNumberOfPartitionedDataSets(static_cast<unsigned int>(models.size()));
    for (unsigned int i = 0; i < models.size(); ++i)
    {
      collection->GetMetaData(i)->Set(
        vtkCompositeDataSet::NAME(), ("Part" + std::to_string(i)).c_str());
      if (has(i))
      {
        collection->SetPartition(i, 0, models[i]);
      }
    }
    return collection;
  }
  // The last one in a block of its own.
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetNumberOfBlocks(1);
  const unsigned int last = static_cast<unsigned int>(models.size()) - 1;
  blocks->SetNumberOfBlocks(last + 1);
  blocks->SetBlock(last, inner);
  for (unsigned int i = 0; i <= last; ++i)
  {
    vtkMultiBlockDataSet* parent = i == last ? inner.Get() : blocks.Get();
    parent->GetMetaData(i == last ? 0 : i)
      ->Set(vtkCompositeDataSet::NAME(), ("Part" + std::to_string(i)).c_str());
    if (has(i))
    {
      parent->SetBlock(i == last ? 0 : i, models[i]);
    }
  }
  return blocks;
}

/** What this process has of each block; null for nothing. */
std::vector<vtkDataSet*> GetLeaves(vtkDataObject* output, std::size_t count)
{
  std::vector<vtkDataSet*> leaves(count, nullptr);
  if (auto collection = vtkPartitionedDataSetCollection::SafeDownCast(output))
  {
    EXPECT_EQ(collection->GetNumberOfPartitionedDataSets(), count);
    for (unsigned int i = 0; i < count; ++i)
    {
      leaves[i] =
        collection->GetNumberOfPartitions(i) > 0 ? collection->GetPartition(i, 0) : nullptr;
    }
    return leaves;
  }
  auto blocks = vtkMultiBlockDataSet::SafeDownCast(output);
  EXPECT_NE(blocks, nullptr);
  if (!blocks)
  {
    return leaves;
  }
  auto iterator = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(blocks->NewTreeIterator());
  iterator->SkipEmptyNodesOff();
  std::size_t i = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem(), ++i)
  {
    if (i < count)
    {
      leaves[i] = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject());
    }
  }
  EXPECT_EQ(i, count);
  return leaves;
}

std::vector<CellKey<4>> MeshAlone(vtkPolyData* polygons, vtkPolyData* meshPoints, double edge)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(polygons);
  mesher->SetInputData(1, meshPoints);
  mesher->SetMaximumEdgeLength(edge);
  mesher->Update();
  return GetCells<4>(mesher->GetOutput(), "RegionId");
}

/** Each block is on one process, and is what the mesher makes of it alone. */
void ExpectBlocks(vtkConformingDelaunayMesher* mesher,
  const std::vector<vtkSmartPointer<vtkPolyData>>& models, vtkPolyData* meshPoints)
{
  const auto meshes = GetLeaves(mesher->GetOutputDataObject(0), models.size());
  const auto boundaries = GetLeaves(mesher->GetOutputDataObject(1), models.size());
  const auto problems = GetLeaves(mesher->GetOutputDataObject(2), models.size());
  for (std::size_t i = 0; i < models.size(); ++i)
  {
    SCOPED_TRACE("block " + std::to_string(i));
    EXPECT_EQ(Sum(meshes[i] ? 1 : 0), 1);
    EXPECT_EQ(boundaries[i] != nullptr, meshes[i] != nullptr);
    EXPECT_EQ(problems[i] != nullptr, meshes[i] != nullptr);
    if (meshes[i])
    {
      EXPECT_TRUE(GetCells<4>(meshes[i], "RegionId") ==
        MeshAlone(models[i], meshPoints, mesher->GetMaximumEdgeLength()));
      EXPECT_GT(boundaries[i]->GetNumberOfCells(), 0);
      EXPECT_NE(meshes[i]->GetFieldData()->GetAbstractArray("Certificate"), nullptr);
      ExpectLinear(vtkPointSet::SafeDownCast(meshes[i]));
    }
  }
}
} // namespace

TEST(ConformingDelaunayBlocks, AreMeshedOnAllProcesses)
{
  const auto models = MakeModels();
  for (bool isCollection : { true, false })
  {
    for (bool isSpread : { true, false })
    {
      vtkNew<vtkConformingDelaunayMesher> mesher;
      mesher->SetMeshForToFewestPoints();
      mesher->SetInputDataObject(MakeInput(models, isCollection, isSpread));
      mesher->SetMaximumEdgeLength(0.5);
      vtkNew<EventRecorder> recorder;
      recorder->Watch(mesher);
      mesher->UpdatePiece(GetRank(), GetSize(), 0);
      EXPECT_EQ(recorder->Errors, "");
      ExpectBlocks(mesher, models, nullptr);
      for (std::size_t i = 1; i < recorder->Progress.size(); ++i)
      {
        EXPECT_GE(recorder->Progress[i], recorder->Progress[i - 1]);
      }
      const auto leaves = GetLeaves(mesher->GetOutputDataObject(0), models.size());
      // 11, 6, 12, 6 and 6 polygons: two processes get 23 and 18 of them.
      const long long own = std::count_if(
        leaves.begin(), leaves.end(), [](vtkDataSet* leaf) { return leaf != nullptr; });
      if (GetSize() == 2)
      {
        EXPECT_TRUE(own == 2 || own == 3) << own;
      }
      else if (GetSize() == 4)
      {
        EXPECT_TRUE(own == 1 || own == 2) << own;
      }
      auto collection =
        vtkPartitionedDataSetCollection::SafeDownCast(mesher->GetOutputDataObject(0));
      if (collection)
      {
        EXPECT_STREQ(collection->GetMetaData(3u)->Get(vtkCompositeDataSet::NAME()), "Part3");
      }
    }
  }
}

TEST(ConformingDelaunayBlocks, GetMeshPointsOfAnyProcess)
{
  const auto models = MakeModels();
  const auto points = MakePoints({ { 0.5, 0.4, 0.6 }, { 20.9, 1.1, 1.2 }, { 10.5, 0.5, 0.4 } });
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputDataObject(MakeInput(models, true));
  mesher->SetMaximumEdgeLength(0.5);
  vtkNew<vtkPolyData> nothing;
  mesher->SetInputData(1, GetRank() == GetSize() - 1 ? points.Get() : nothing.Get());
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  ExpectBlocks(mesher, models, points);
}

TEST(ConformingDelaunayBlocks, PiecesOfABlockAreOneSurface)
{
  // Each process has some sides of the cube; partitions on one process as well.
  const auto cube = MakeCube();
  vtkNew<vtkPartitionedDataSetCollection> input;
  input->SetNumberOfPartitionedDataSets(1);
  for (vtkIdType side = 0; side < 6; ++side)
  {
    if (side % GetSize() == GetRank())
    {
      vtkNew<vtkPolyData> piece;
      piece->SetPoints(cube->GetPoints());
      piece->GetPointData()->ShallowCopy(cube->GetPointData());
      vtkNew<vtkCellArray> polys;
      vtkNew<vtkIdList> ids;
      cube->GetCellPoints(side, ids);
      polys->InsertNextCell(ids);
      piece->SetPolys(polys);
      input->SetPartition(0, input->GetNumberOfPartitions(0), piece);
    }
  }
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputDataObject(input);
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  const auto leaves = GetLeaves(mesher->GetOutputDataObject(0), 1);
  EXPECT_EQ(Sum(leaves[0] ? leaves[0]->GetNumberOfCells() : 0), 6);
  if (leaves[0])
  {
    EXPECT_NEAR(GetVolume(vtkUnstructuredGrid::SafeDownCast(leaves[0])), 1.0, 1e-14);
  }
}

TEST(ConformingDelaunayBlocks, AnErrorNamesTheBlockAndEndsAll)
{
  for (bool isCollection : { true, false })
  {
    auto models = MakeModels();
    models[3] = MakeCubeWithNaN();
    vtkNew<vtkConformingDelaunayMesher> mesher;
    mesher->SetMeshForToFewestPoints();
    mesher->SetInputDataObject(MakeInput(models, isCollection));
    vtkNew<EventRecorder> recorder;
    recorder->Watch(mesher);
    mesher->UpdatePiece(GetRank(), GetSize(), 0);
    EXPECT_TRUE(Contains(recorder->Errors, "Block 3 (Part3): Coordinates that are not finite"))
      << recorder->Errors;
    const auto composite = vtkCompositeDataSet::SafeDownCast(mesher->GetOutputDataObject(0));
    EXPECT_NE(composite, nullptr);
    EXPECT_TRUE(composite && composite->GetNumberOfCells() == 0);
    // It works again when the block is good.
    models[3] = MakeCube();
    mesher->SetInputDataObject(MakeInput(models, isCollection));
    mesher->UpdatePiece(GetRank(), GetSize(), 0);
    ExpectBlocks(mesher, models, nullptr);
  }
}

TEST(ConformingDelaunayBlocks, OtherDataAreRefused)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  vtkNew<vtkPartitionedDataSetCollection> grids;
  vtkNew<vtkUnstructuredGrid> grid;
  grids->SetPartition(0, 0, grid);
  mesher->SetInputDataObject(grids);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(mesher);
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_TRUE(Contains(recorder->Errors, "Block 0 is no vtkPolyData")) << recorder->Errors;

  // Different structures.
  recorder->Errors.clear();
  vtkNew<vtkPartitionedDataSetCollection> uneven;
  uneven->SetNumberOfPartitionedDataSets(1 + static_cast<unsigned int>(GetRank()));
  mesher->SetInputDataObject(uneven);
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(Contains(recorder->Errors, "do not have the same blocks"), GetSize() > 1)
    << recorder->Errors;

  // Nothing at all is nothing to complain about.
  recorder->Errors.clear();
  vtkNew<vtkMultiBlockDataSet> nothing;
  mesher->SetInputDataObject(nothing);
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(recorder->Errors, "");
}

TEST(ConformingDelaunayBlocks, ASimpleInputStillHasASimpleOutput)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  EXPECT_NE(mesher->GetOutput(), nullptr);
  mesher->SetInputDataObject(MakeInput(MakeModels(), true));
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(mesher->GetOutput(), nullptr);
  mesher->SetInputDataObject(MakeCube());
  mesher->UpdatePiece(0, 1, 0);
  EXPECT_NE(mesher->GetOutput(), nullptr);
  EXPECT_TRUE(mesher->GetOutput() && mesher->GetOutput()->GetNumberOfCells() == 6);
}

TEST(ConformingDelaunayBlocks, AbortOfOneProcessEndsAll)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  vtkNew<EventRecorder> recorder;
  recorder->Watch(mesher);
  recorder->AbortAt = GetRank() == 0 ? 0.05 : 2.0;
  mesher->SetInputDataObject(MakeInput(MakeModels(), true));
  mesher->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(recorder->Errors, "");
  auto composite = vtkCompositeDataSet::SafeDownCast(mesher->GetOutputDataObject(0));
  EXPECT_TRUE(composite && composite->GetNumberOfCells() == 0);
}

int main(int argc, char** argv)
{
  return testing_parallel::RunAllTests(argc, argv);
}
