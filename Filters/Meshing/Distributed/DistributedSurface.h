// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistributedSurface.h
 * @brief A surface of which processes have pieces, whole on all of them.
 *
 * Private to this module. Points at the same place are one, and triangles that two processes have
 * as well; diagonals in flat cocircular facets are those of the pulling rule, by the points'
 * numbers.
 */
#ifndef DistributedSurface_h
#define DistributedSurface_h

#include "Distributed/AttributeRows.h"
#include "Distributed/ProcessGroup.h"

#include "Core/Basics/Status.h"
#include "Core/Delaunay/PartPoints.h"
#include "Core/Meshes/TriangleMesh.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstdint>
#include <utility>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace vtkDistributed
{
class DistributedSurface
{
public:
  explicit DistributedSurface(const ProcessGroup& processes) : Processes(processes) {}

  /** The piece of this process. */
  cdm::Status Read(vtkPolyData* input);
  /** Called by all processes, with the numbered points of the piece. */
  cdm::Status Gather(vtkPolyData* input, const std::vector<cdm::NumberedPoint>& points);
  /** Whether any process has a triangle. */
  bool Exists() const { return this->IsThere; }
  /**
   * Checks, on each process by itself, what the surface encloses, and flips diagonals to those of
   * the pulling rule.
   */
  cdm::Status Check();

  /** The surface, with points in the order of their numbers. It has labels before Check() only. */
  const cdm::TriangleMesh& GetMesh() const { return this->Mesh; }
  /** The regions on the sides of the triangles, or PartRegions::Unknown. */
  const std::vector<cdm::RegionPair>& GetSideRegions() const { return this->SideRegions; }
  /** A row for each triangle. */
  const vtkSmartPointer<vtkTable>& GetCellData() const { return this->CellData; }
  /**
   * Triangles of a status as cells of the input, or in the message with the process they are of.
   */
  void NameTriangles(cdm::Status& status) const;

private:
  cdm::Status GatherTriangles(
    const std::vector<cdm::NumberedPoint>& points, bool hasLabels, std::vector<Row>& rows);
  std::vector<vtkSmartPointer<vtkTable>> GatherCellData(vtkPolyData* input) const;
  cdm::Status RemoveCopiedTriangles(std::vector<Row>& rows);

  const ProcessGroup& Processes;
  bool IsThere = false;
  cdm::TriangleMesh Mesh;
  std::vector<cdm::RegionPair> SideRegions;
  /** The cells of this process that are triangles. */
  std::vector<vtkIdType> OwnCells;
  /** The process of each triangle, and its cell there. */
  std::vector<std::pair<int, std::int64_t>> Sources;
  vtkSmartPointer<vtkTable> CellData;
};
} // namespace vtkDistributed

#endif
