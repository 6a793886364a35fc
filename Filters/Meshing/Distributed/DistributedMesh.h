// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistributedMesh.h
 * @brief Tetrahedralizes points, or the inside of a surface, that are spread over processes.
 *
 * Private to this module: what vtkDistributedTetrahedralizer does, step by step. Between two steps
 * all processes agree that they go on.
 */
#ifndef DistributedMesh_h
#define DistributedMesh_h

#include "Distributed/DistributedPoints.h"
#include "Distributed/DistributedSurface.h"
#include "Distributed/ProcessGroup.h"

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Delaunay/PartTetrahedralization.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vtkType.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace cdm
{
class PartRegions;
}
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace vtkDistributed
{
class DistributedMesh
{
public:
  DistributedMesh(
    ProcessGroup& processes, const cdm::ExecutionContext& context, int numberOfGhostLevels);

  /** Called by all processes with their pieces; the second one may be null. */
  cdm::Status Run(vtkPointSet* input, vtkPointSet* meshPoints);

  /** The tetrahedra of this process and its ghosts. */
  void MakeMesh(vtkUnstructuredGrid* output) const;
  /** The boundary triangles of this process. */
  void MakeBoundary(vtkPolyData* output) const;

  int GetNumberOfRounds() const { return this->NumberOfRounds; }
  /** Points of others that this process knows. */
  vtkIdType GetNumberOfHaloPoints() const { return this->NumberOfHaloPoints; }
  /** Unused mesh points on all processes. */
  vtkIdType GetNumberOfUnusedMeshPoints() const { return this->NumberOfUnusedMeshPoints; }

private:
  /** A tetrahedron of the output, its lowest numbered point first. */
  struct Cell
  {
    cdm::TetrahedronIds Ids;
    cdm::Id Region;
  };

  using Numbers = std::array<std::int64_t, 4>;
  /** A tetrahedron with the numbers of its points, ascending. */
  using KeyedTetrahedron = std::pair<Numbers, cdm::Id>;
  class GhostLevels;

  cdm::Status MakePart();
  cdm::Status FindSimplex(std::vector<cdm::NumberedPoint>& simplex);
  cdm::Status Tetrahedralize();
  cdm::Status UpdateTetrahedra(const cdm::ExecutionContext& context, bool& isFinal);
  cdm::Status FindRegions();
  cdm::Status ExchangeRegions(const std::vector<KeyedTetrahedron>& shared,
    const std::vector<cdm::Id>& news, cdm::PartRegions& regions);
  Numbers GetKey(cdm::Id tetrahedron) const;
  std::vector<KeyedTetrahedron> CollectShared() const;
  std::vector<cdm::TriangleIds> CollectPartTriangles();
  void FindSurfacePlaces();
  void CollectOwn();
  cdm::Status AddGhosts();
  void CollectBoundary();
  std::vector<char> FindUsed() const;
  Cell MakeCell(const cdm::TetrahedronIds& ids, cdm::Id region) const;
  void SortCells(std::ptrdiff_t begin, std::ptrdiff_t end);
  /** Whether the point with the lowest number is one of this process. */
  template <typename Ids>
  bool OwnsLowest(const Ids& ids) const;
  std::vector<cdm::Id> CompressPoints(
    const std::vector<cdm::Id>& places, vtkPointSet* output) const;

  ProcessGroup& Processes;
  const cdm::ExecutionContext& Context;
  int NumberOfGhostLevels;

  DistributedPoints Input;
  DistributedSurface Surface;
  std::vector<cdm::NumberedPoint> OwnPoints;
  std::unique_ptr<cdm::PartTetrahedralization> Part;

  /** Points of the part, then those of ghosts. */
  std::vector<cdm::NumberedPoint> Points;
  cdm::Id NumberOfOwnPoints = 0;
  cdm::TetMesh Mesh;
  std::vector<cdm::TriangleIds> Hull;
  /** Index of each point of the surface; NoId for those that this process does not know. */
  std::vector<cdm::Id> SurfacePlaces;
  /** The triangles of the surface with points of the part, and the regions on their sides. */
  std::vector<cdm::Id> PartTriangles;
  std::vector<cdm::RegionPair> PartLabels;
  /** Tetrahedra of the output, the own ones first. */
  std::vector<Cell> Cells;
  std::size_t NumberOfOwnCells = 0;
  /** The boundary, without its points. */
  cdm::TriangleMesh Boundary;

  int NumberOfRounds = 0;
  vtkIdType NumberOfHaloPoints = 0;
  vtkIdType NumberOfUnusedMeshPoints = 0;
};

template <typename Ids>
bool DistributedMesh::OwnsLowest(const Ids& ids) const
{
  return *std::min_element(ids.begin(), ids.end(),
           [this](cdm::Id a, cdm::Id b)
           { return this->Points[a].Number < this->Points[b].Number; }) < this->NumberOfOwnPoints;
}
} // namespace vtkDistributed

#endif
