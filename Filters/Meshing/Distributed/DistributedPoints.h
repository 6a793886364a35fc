// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DistributedPoints.h
 * @brief Points of which processes have any pieces: numbers them, deals them out by where they lie,
 * and gets their data to where they are needed.
 *
 * Private to this module. Numbers are the global ids, if all points of an input have some,
 * otherwise they count the points from the first process to the last; those of the mesh points
 * follow.
 */
#ifndef DistributedPoints_h
#define DistributedPoints_h

#include "Distributed/AttributeRows.h"
#include "Distributed/ProcessGroup.h"

#include "Core/Basics/Status.h"
#include "Core/Delaunay/PartPoints.h"
#include "Core/Search/SpacePartition.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstdint>
#include <memory>
#include <vector>

class vtkDataSetAttributes;
class vtkPointSet;
class vtkTable;

namespace vtkDistributed
{
class DistributedPoints
{
public:
  explicit DistributedPoints(ProcessGroup& processes) : Processes(processes) {}

  /** The points of this process in one of the two inputs; the second may be null. */
  cdm::Status Read(vtkPointSet* input, const char* name, int port);
  /** Called by all processes; the second input may be null. */
  cdm::Status Number(vtkPointSet* input, vtkPointSet* meshPoints);
  /** The points that this process has read, with their numbers. */
  const std::vector<cdm::NumberedPoint>& GetPiece(int port) const
  {
    return this->Pieces[port].Points;
  }
  /** The lowest number that mesh points may have. */
  std::int64_t GetFirstMeshPoint() const { return this->FirstMeshPoint; }

  /**
   * Called by all processes: cuts space, and sends each point with its data to the process in whose
   * cell it lies. own receives those of this process, ascending by number; numberOfCopies how many
   * points with at least the number firstCounted are left out because they are copies of others.
   */
  cdm::Status Distribute(
    std::int64_t firstCounted, std::vector<cdm::NumberedPoint>& own, vtkIdType& numberOfCopies);
  int GetOwner(const cdm::Vec3& position) const { return this->Partition->GetPart(position); }
  const cdm::Box& GetCell() const { return this->Partition->GetCell(this->Processes.GetRank()); }

  /** Called by all processes: gets the data of points that are used here, the own ones first. */
  cdm::Status FetchData(const std::vector<cdm::NumberedPoint>& points, cdm::Id numberOfOwnPoints,
    const std::vector<char>& isUsed);
  /** The data of points that are used, by their places. */
  void CopyData(const std::vector<cdm::Id>& places, vtkDataSetAttributes* to) const;

private:
  struct Piece
  {
    std::vector<cdm::NumberedPoint> Points;
    /** The arrays that all processes have in both inputs. */
    vtkSmartPointer<vtkDataSetAttributes> Data;
  };

  cdm::Status NumberPoints(vtkPointSet* input, int port);
  cdm::Status CheckNumbers();
  void ChooseArrays(vtkPointSet* input, vtkPointSet* meshPoints);

  ProcessGroup& Processes;
  Piece Pieces[2];
  bool HasGlobalIds = false;
  bool HasArrays = false;
  std::int64_t FirstMeshPoint = 0;
  std::unique_ptr<cdm::SpacePartition> Partition;
  std::vector<vtkSmartPointer<vtkTable>> Tables;
  /** The table and the row of each point. */
  std::vector<Row> Rows;
};
} // namespace vtkDistributed

#endif
