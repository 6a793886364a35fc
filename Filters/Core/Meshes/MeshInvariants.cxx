// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/MeshInvariants.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SimplexIncidence.h"

#include <algorithm>
#include <string>

namespace cdm
{
namespace
{
bool HasRightNeighbors(const TetMesh& mesh, Id tetrahedron)
{
  const Id numberOfFacets = static_cast<Id>(4 * mesh.Tetrahedra.size());
  for (int facet = 0; facet < 4; ++facet)
  {
    const Id neighbor = mesh.Neighbors[tetrahedron][facet];
    if (neighbor == NoId)
    {
      continue;
    }
    if (neighbor < 0 || neighbor >= numberOfFacets ||
      mesh.Neighbors[neighbor / 4][neighbor % 4] != 4 * tetrahedron + facet)
    {
      return false;
    }
    const TriangleIds own = GetFacet(mesh.Tetrahedra[tetrahedron], facet);
    const TriangleIds other = GetFacet(mesh.Tetrahedra[neighbor / 4], neighbor % 4);
    if (!std::is_permutation(own.begin(), own.end(), other.begin()))
    {
      return false;
    }
  }
  return true;
}
} // namespace

Status CheckTetrahedra(const TetMesh& mesh)
{
  Status status = CheckNumberOfTetrahedra(mesh.Tetrahedra.size())
                    .Then([&] { return CheckIdRange(mesh.Points.size(), "points"); });
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<Id> cells = FindCellsOutOfRange(mesh.Tetrahedra, mesh.Points.size());
  if (!cells.empty())
  {
    return Status::InvalidInput(
      std::to_string(cells.size()) + " tetrahedra refer to points that do not exist.", cells);
  }
  return {};
}

namespace
{
Status RunBuildNeighbors(TetMesh& mesh, int numberOfThreads)
{
  Status status = CheckTetrahedra(mesh);
  if (!status.IsOk())
  {
    return status;
  }
  mesh.Neighbors.resize(mesh.Tetrahedra.size());
  const SimplexIncidence incidence(mesh, numberOfThreads);
  const ParallelLoopOptions loop{ numberOfThreads, 2048 };
  std::vector<std::vector<Id>> overfull(GetNumberOfBlocks(mesh.Points.size(), loop));
  const auto build = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    std::vector<SimplexIncidence::Record> scratch;
    const auto join = [&](const TriangleIds&, auto first, auto last)
    {
      for (auto record = first; record != last; ++record)
      {
        const auto other = record == first ? first + 1 : first;
        mesh.Neighbors[record->Simplex / 4][record->Simplex % 4] =
          last - first == 2 ? other->Simplex : NoId;
        if (last - first > 2)
        {
          overfull[block].push_back(record->Simplex / 4);
        }
      }
    };
    for (std::size_t point = begin; point < end; ++point)
    {
      incidence.ForEachFacet(static_cast<Id>(point), scratch, join);
    }
  };
  ParallelLoop(mesh.Points.size(), loop, {}, "", build);
  std::vector<Id> cells;
  for (const std::vector<Id>& ofBlock : overfull)
  {
    cells.insert(cells.end(), ofBlock.begin(), ofBlock.end());
  }
  if (!cells.empty())
  {
    SortUnique(cells);
    return Status::InvalidInput(
      std::to_string(cells.size()) + " tetrahedra share a facet with more than one other.", cells);
  }
  return {};
}
} // namespace

Status BuildNeighbors(TetMesh& mesh, int numberOfThreads)
{
  return RunGuarded([&] { return RunBuildNeighbors(mesh, numberOfThreads); });
}

namespace
{
Status RunCheckMeshInvariants(const TetMesh& mesh, int numberOfThreads)
{
  const std::size_t count = mesh.Tetrahedra.size();
  if (mesh.Regions.size() != count || mesh.Neighbors.size() != count)
  {
    return Status::InvalidInput("The mesh needs one region and four neighbors for each "
                                "tetrahedron.");
  }
  const auto isRight = [&mesh](Id tetrahedron)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[tetrahedron];
    const std::vector<Vec3>& points = mesh.Points;
    return std::all_of(ids.begin(), ids.end(),
             [&](Id point) {
               return point >= 0 && point < static_cast<Id>(points.size()) &&
                 IsFinite(points[point]);
             }) &&
      Orientation(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]]) > 0 &&
      HasRightNeighbors(mesh, tetrahedron);
  };
  const ParallelLoopOptions options{ numberOfThreads };
  std::vector<std::vector<Id>> blocks(GetNumberOfBlocks(count, options));
  ParallelLoop(count, options, {}, "",
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (!isRight(static_cast<Id>(t)))
        {
          blocks[block].push_back(static_cast<Id>(t));
        }
      }
    });
  std::vector<Id> wrong;
  for (const std::vector<Id>& block : blocks)
  {
    wrong.insert(wrong.end(), block.begin(), block.end());
  }
  return wrong.empty() ? Status{}
                       : Status::InvalidInput(std::to_string(wrong.size()) +
                             " tetrahedra are inverted, flat, or have wrong points or neighbors: "
                             "only valid meshes can be changed.",
                           wrong);
}
} // namespace

Status CheckMeshInvariants(const TetMesh& mesh, int numberOfThreads)
{
  return RunGuarded([&] { return RunCheckMeshInvariants(mesh, numberOfThreads); });
}
} // namespace cdm
