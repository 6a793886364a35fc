// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockDistribution.h
 * @brief Polygons in blocks: which process gets which block, and composite outputs like the input.
 *
 * Private to this module. A block is a partitioned data set of a collection, with all of its
 * partitions, which are pieces of one surface; or a leaf of blocks in blocks. Where several
 * processes have pieces of a block they are appended, from the first process to the last.
 *
 * Blocks go to processes by their number of cells: the largest one that is left to the process that
 * has least so far.
 */
#ifndef BlockDistribution_h
#define BlockDistribution_h

#include "Distributed/ProcessGroup.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObjectTree;
class vtkDataSet;
class vtkPolyData;

namespace vtkDistributed
{
class BlockDistribution
{
public:
  struct Block
  {
    /** Place among all blocks, empty ones included. */
    std::size_t Index;
    /** Its name in messages: its number, and its own name if it has one. */
    std::string Name;
    vtkSmartPointer<vtkPolyData> Polygons;
  };

  /** Called by all processes, whose data have the same structure. */
  cdm::Status Run(ProcessGroup& processes, vtkDataObjectTree* input);

  /** The blocks of this process, by index. */
  const std::vector<Block>& GetBlocks() const { return this->Own; }

  /** An output with the structure and names of the input, to put blocks into. */
  static void CopyStructure(vtkDataObjectTree* input, vtkDataObjectTree* output);
  static void SetBlock(vtkDataObjectTree* output, std::size_t index, vtkDataSet* block);

private:
  cdm::Status Assign(const ProcessGroup& processes);
  cdm::Status Send(ProcessGroup& processes);

  /** The pieces of each block that this process has. */
  std::vector<Block> Pieces;
  std::vector<int> Owners;
  std::vector<Block> Own;
};

/** Makes all pieces of a data set known to all processes; null if there are none. */
vtkSmartPointer<vtkDataSet> GatherDataSet(const ProcessGroup& processes, vtkDataSet* piece);
} // namespace vtkDistributed

#endif
