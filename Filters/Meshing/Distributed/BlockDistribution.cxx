// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/BlockDistribution.h"

#include <vtkAppendFilter.h>
#include <vtkAppendPolyData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObjectTree.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <numeric>

namespace vtkDistributed
{
namespace
{
vtkSmartPointer<vtkDataObjectTreeIterator> GetLeaves(vtkDataObjectTree* tree)
{
  auto iterator = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(tree->NewTreeIterator());
  iterator->VisitOnlyLeavesOn();
  iterator->SkipEmptyNodesOff();
  iterator->InitTraversal();
  return iterator;
}

std::string MakeName(std::size_t index, vtkInformation* metaData)
{
  const bool hasName = metaData && metaData->Has(vtkCompositeDataSet::NAME());
  return "Block " + std::to_string(index) +
    (hasName ? std::string(" (") + metaData->Get(vtkCompositeDataSet::NAME()) + ")" : "");
}

/** Appends several pieces to one surface. */
vtkSmartPointer<vtkPolyData> Append(const std::vector<vtkSmartPointer<vtkPolyData>>& pieces)
{
  if (pieces.size() == 1)
  {
    return pieces.front();
  }
  vtkNew<vtkAppendPolyData> append;
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  for (vtkPolyData* piece : pieces)
  {
    append->AddInputData(piece);
  }
  append->Update();
  return append->GetOutput();
}

cdm::Status NotPolygons(const std::string& name, vtkDataObject* data)
{
  return cdm::Status::InvalidInput(name + " is no vtkPolyData, but " + data->GetClassName() +
    ". Extract its surface or leave it out.");
}

/** The polygons of all leaves of a data set. */
cdm::Status CollectLeaves(
  vtkDataObjectTree* tree, const std::string& name, vtkSmartPointer<vtkPolyData>& polygons)
{
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  const auto leaves = GetLeaves(tree);
  for (; !leaves->IsDoneWithTraversal(); leaves->GoToNextItem())
  {
    vtkDataObject* leaf = leaves->GetCurrentDataObject();
    auto piece = vtkPolyData::SafeDownCast(leaf);
    if (leaf && !piece)
    {
      return NotPolygons(name, leaf);
    }
    if (piece && piece->GetNumberOfCells() > 0)
    {
      pieces.emplace_back(piece);
    }
  }
  polygons = pieces.empty() ? nullptr : Append(pieces);
  return {};
}
} // namespace

//--------------------------------------------------------------------------------------------------
cdm::Status BlockDistribution::Run(ProcessGroup& processes, vtkDataObjectTree* input)
{
  cdm::Status status = processes.Do(
    [&]
    {
      cdm::Status step;
      if (auto collection = vtkPartitionedDataSetCollection::SafeDownCast(input))
      {
        for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets() && step.IsOk();
             ++i)
        {
          vtkInformation* metaData =
            collection->HasMetaData(i) ? collection->GetMetaData(i) : nullptr;
          this->Pieces.push_back({ i, MakeName(i, metaData), nullptr });
          step = CollectLeaves(collection->GetPartitionedDataSet(i), this->Pieces.back().Name,
            this->Pieces.back().Polygons);
        }
        return step;
      }
      if (vtkPartitionedDataSet::SafeDownCast(input))
      {
        this->Pieces.push_back({ 0, MakeName(0, nullptr), nullptr });
        return CollectLeaves(input, this->Pieces.back().Name, this->Pieces.back().Polygons);
      }
      const auto leaves = GetLeaves(input);
      for (; !leaves->IsDoneWithTraversal(); leaves->GoToNextItem())
      {
        vtkDataObject* leaf = leaves->GetCurrentDataObject();
        const std::size_t index = this->Pieces.size();
        this->Pieces.push_back({ index,
          MakeName(index, leaves->HasCurrentMetaData() ? leaves->GetCurrentMetaData() : nullptr),
          vtkPolyData::SafeDownCast(leaf) });
        if (leaf && !this->Pieces.back().Polygons)
        {
          return NotPolygons(this->Pieces.back().Name, leaf);
        }
      }
      return step;
    });
  return std::move(status)
    .Then([&] { return this->Assign(processes); })
    .Then([&] { return this->Send(processes); });
}

//--------------------------------------------------------------------------------------------------
cdm::Status BlockDistribution::Assign(const ProcessGroup& processes)
{
  const std::size_t count = this->Pieces.size();
  std::vector<std::int64_t> cells;
  for (const Block& piece : this->Pieces)
  {
    cells.push_back(piece.Polygons ? piece.Polygons->GetNumberOfCells() : 0);
  }
  const std::vector<std::int64_t> all = processes.GatherAll(cells);
  if (processes.Sum(all.size() == count * static_cast<std::size_t>(processes.GetSize()) ? 0 : 1) >
    0)
  {
    return cdm::Status::InvalidInput(
      "The processes do not have the same blocks. Give all of them the same structure, with empty "
      "blocks where they have nothing.");
  }
  std::vector<std::int64_t> sizes(count, 0);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    sizes[i % count] += all[i];
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
    [&sizes](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::vector<std::int64_t> loads(static_cast<std::size_t>(processes.GetSize()), 0);
  this->Owners.assign(count, -1);
  for (std::size_t block : order)
  {
    if (sizes[block] > 0)
    {
      const auto least = std::min_element(loads.begin(), loads.end());
      this->Owners[block] = static_cast<int>(least - loads.begin());
      *least += sizes[block];
    }
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status BlockDistribution::Send(ProcessGroup& processes)
{
  const std::size_t count = static_cast<std::size_t>(processes.GetSize());
  // A message holds for each of its blocks the index, the length, and the polygons.
  std::vector<ProcessGroup::Bytes> messages(count);
  cdm::Status status = processes.Do(
    [&]
    {
      for (const Block& piece : this->Pieces)
      {
        const int owner = this->Owners[piece.Index];
        if (piece.Polygons && piece.Polygons->GetNumberOfCells() > 0 &&
          owner != processes.GetRank())
        {
          const ProcessGroup::Bytes polygons = ProcessGroup::Pack(piece.Polygons);
          const ProcessGroup::Bytes head =
            ProcessGroup::Pack(std::vector<std::size_t>{ piece.Index, polygons.size() });
          messages[owner].insert(messages[owner].end(), head.begin(), head.end());
          messages[owner].insert(messages[owner].end(), polygons.begin(), polygons.end());
        }
      }
      return cdm::Status();
    });
  std::vector<ProcessGroup::Bytes> received;
  status =
    std::move(status).Then([&] { return processes.Exchange(std::move(messages), received); });
  if (!status.IsOk())
  {
    return status;
  }
  return processes.Do(
    [&]
    {
      std::vector<std::vector<vtkSmartPointer<vtkPolyData>>> pieces(this->Pieces.size());
      for (std::size_t rank = 0; rank < count; ++rank)
      {
        for (std::size_t i = 0; static_cast<int>(rank) == processes.GetRank() && i < pieces.size();
             ++i)
        {
          vtkPolyData* own = this->Pieces[i].Polygons;
          if (this->Owners[i] == processes.GetRank() && own && own->GetNumberOfCells() > 0)
          {
            pieces[i].emplace_back(own);
          }
        }
        const ProcessGroup::Bytes& bytes = received[rank];
        for (auto begin = bytes.begin(); begin != bytes.end();)
        {
          const auto head =
            ProcessGroup::Unpack<std::size_t>({ begin, begin + 2 * sizeof(std::size_t) });
          begin += 2 * sizeof(std::size_t);
          const auto end = begin + static_cast<std::ptrdiff_t>(head[1]);
          pieces[head[0]].emplace_back(
            vtkPolyData::SafeDownCast(ProcessGroup::UnpackData({ begin, end })));
          begin = end;
        }
      }
      for (std::size_t i = 0; i < pieces.size(); ++i)
      {
        if (!pieces[i].empty())
        {
          this->Own.push_back({ i, this->Pieces[i].Name, Append(pieces[i]) });
        }
      }
      return cdm::Status();
    });
}

//--------------------------------------------------------------------------------------------------
void BlockDistribution::CopyStructure(vtkDataObjectTree* input, vtkDataObjectTree* output)
{
  if (auto collection = vtkPartitionedDataSetCollection::SafeDownCast(input))
  {
    // Its structure is kept without the partitions, which the blocks of the output do not have.
    auto to = vtkPartitionedDataSetCollection::SafeDownCast(output);
    to->SetNumberOfPartitionedDataSets(collection->GetNumberOfPartitionedDataSets());
    for (unsigned int i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
    {
      if (collection->HasMetaData(i))
      {
        to->GetMetaData(i)->Copy(collection->GetMetaData(i));
      }
    }
  }
  else if (!vtkPartitionedDataSet::SafeDownCast(input))
  {
    output->CopyStructure(input);
  }
}

//--------------------------------------------------------------------------------------------------
void BlockDistribution::SetBlock(vtkDataObjectTree* output, std::size_t index, vtkDataSet* block)
{
  if (auto collection = vtkPartitionedDataSetCollection::SafeDownCast(output))
  {
    collection->SetPartition(static_cast<unsigned int>(index), 0, block);
  }
  else if (auto partitions = vtkPartitionedDataSet::SafeDownCast(output))
  {
    partitions->SetPartition(0, block);
  }
  else
  {
    const auto leaves = GetLeaves(output);
    for (std::size_t i = 0; i < index; ++i)
    {
      leaves->GoToNextItem();
    }
    output->SetDataSet(leaves, block);
  }
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkDataSet> GatherDataSet(const ProcessGroup& processes, vtkDataSet* piece)
{
  const bool isEmpty = !piece || piece->GetNumberOfPoints() == 0;
  if (processes.IsAlone())
  {
    return piece;
  }
  vtkNew<vtkAppendFilter> append;
  vtkSmartPointer<vtkDataSet> last;
  int count = 0;
  for (const ProcessGroup::Bytes& bytes :
    processes.Gather(isEmpty ? ProcessGroup::Bytes() : ProcessGroup::Pack(piece)))
  {
    if (!bytes.empty())
    {
      last = vtkDataSet::SafeDownCast(ProcessGroup::UnpackData(bytes));
      append->AddInputData(last);
      ++count;
    }
  }
  if (count < 2)
  {
    return last;
  }
  append->Update();
  return append->GetOutput();
}
} // namespace vtkDistributed
