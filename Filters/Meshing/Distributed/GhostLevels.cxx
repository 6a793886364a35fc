// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/GhostLevels.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace vtkDistributed
{
//--------------------------------------------------------------------------------------------------
void DistributedMesh::GhostLevels::Start()
{
  const DistributedMesh& mesh = this->Owner;
  this->NumberOfPartPoints = static_cast<cdm::Id>(mesh.Points.size());
  this->IsReached.resize(mesh.Points.size(), 0);
  this->IsTaken.resize(mesh.Mesh.Tetrahedra.size(), 0);
  this->Starts.resize(mesh.Points.size() + 1, 0);
  const auto isMeshed = [&mesh](std::size_t t)
  { return mesh.Mesh.Regions[t] != cdm::OutsideRegion; };
  for (std::size_t t = 0; t < this->IsTaken.size(); ++t)
  {
    this->IsTaken[t] = isMeshed(t) && mesh.OwnsLowest(mesh.Mesh.Tetrahedra[t]);
    for (cdm::Id id : mesh.Mesh.Tetrahedra[t])
    {
      this->Starts[id] += isMeshed(t);
    }
  }
  std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
  this->Stars.resize(static_cast<std::size_t>(this->Starts.back()));
  for (std::size_t t = this->IsTaken.size(); t-- > 0;)
  {
    for (cdm::Id id : mesh.Mesh.Tetrahedra[t])
    {
      if (isMeshed(t))
      {
        this->Stars[--this->Starts[id]] = static_cast<cdm::Id>(t);
      }
    }
  }
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    this->Places.emplace(mesh.Points[i].Number, static_cast<cdm::Id>(i));
  }
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedMesh::GhostLevels::AddLevel()
{
  ProcessGroup& processes = this->Owner.Processes;
  const std::vector<std::vector<std::int64_t>> requests = this->TakeOwn();
  std::vector<std::vector<std::int64_t>> asked;
  std::vector<std::vector<GhostTetrahedron>> answers;
  std::vector<std::vector<GhostTetrahedron>> received;
  const auto answer = [&]
  {
    std::transform(asked.begin(), asked.end(), std::back_inserter(answers),
      [this](const std::vector<std::int64_t>& numbers) { return this->Answer(numbers); });
    return cdm::Status();
  };
  const auto take = [&]
  {
    for (const std::vector<GhostTetrahedron>& message : received)
    {
      this->Take(message);
    }
    return cdm::Status();
  };
  return processes.Exchange(requests, asked)
    .Then([&] { return processes.Do(answer); })
    .Then([&] { return processes.Exchange(answers, received); })
    .Then([&] { return processes.Do(take); });
}

//--------------------------------------------------------------------------------------------------
std::vector<std::vector<std::int64_t>> DistributedMesh::GhostLevels::TakeOwn()
{
  DistributedMesh& mesh = this->Owner;
  std::vector<std::vector<std::int64_t>> requests(
    static_cast<std::size_t>(mesh.Processes.GetSize()));
  const std::size_t endOfLevel = mesh.Cells.size();
  for (; this->FirstOfLevel < endOfLevel; ++this->FirstOfLevel)
  {
    for (cdm::Id id : cdm::TetrahedronIds(mesh.Cells[this->FirstOfLevel].Ids))
    {
      if (this->IsReached[id])
      {
        continue;
      }
      this->IsReached[id] = 1;
      for (cdm::Id i = id < this->NumberOfPartPoints ? this->Starts[id] : 0;
           id < this->NumberOfPartPoints && i < this->Starts[id + 1]; ++i)
      {
        const cdm::Id t = this->Stars[i];
        if (!this->IsTaken[t])
        {
          this->IsTaken[t] = 1;
          mesh.Cells.push_back(mesh.MakeCell(mesh.Mesh.Tetrahedra[t], mesh.Mesh.Regions[t]));
        }
      }
      if (id >= mesh.NumberOfOwnPoints)
      {
        requests[mesh.Input.GetOwner(mesh.Points[id].Position)].push_back(mesh.Points[id].Number);
      }
    }
  }
  return requests;
}

//--------------------------------------------------------------------------------------------------
std::vector<DistributedMesh::GhostLevels::GhostTetrahedron> DistributedMesh::GhostLevels::Answer(
  const std::vector<std::int64_t>& numbers) const
{
  const DistributedMesh& mesh = this->Owner;
  std::vector<GhostTetrahedron> answer;
  std::set<cdm::Id> sent;
  for (std::int64_t number : numbers)
  {
    const cdm::Id id = this->Places.at(number);
    for (cdm::Id k = this->Starts[id]; k < this->Starts[id + 1]; ++k)
    {
      const cdm::Id t = this->Stars[k];
      if (sent.insert(t).second)
      {
        const cdm::TetrahedronIds& ids = mesh.Mesh.Tetrahedra[t];
        answer.push_back(
          { { mesh.Points[ids[0]], mesh.Points[ids[1]], mesh.Points[ids[2]], mesh.Points[ids[3]] },
            mesh.Mesh.Regions[t] });
      }
    }
  }
  return answer;
}

//--------------------------------------------------------------------------------------------------
void DistributedMesh::GhostLevels::Take(const std::vector<GhostTetrahedron>& message)
{
  DistributedMesh& mesh = this->Owner;
  for (const GhostTetrahedron& item : message)
  {
    cdm::TetrahedronIds ids;
    Numbers key;
    for (int i = 0; i < 4; ++i)
    {
      const auto place =
        this->Places.emplace(item.Points[i].Number, static_cast<cdm::Id>(mesh.Points.size()));
      if (place.second)
      {
        mesh.Points.push_back(item.Points[i]);
        this->IsReached.push_back(0);
      }
      ids[i] = place.first->second;
      key[i] = item.Points[i].Number;
    }
    std::sort(key.begin(), key.end());
    // Those at own points are known.
    if (*std::min_element(ids.begin(), ids.end()) >= mesh.NumberOfOwnPoints &&
      this->Ghosts.insert(key).second)
    {
      mesh.Cells.push_back(mesh.MakeCell(ids, static_cast<cdm::Id>(item.Region)));
    }
  }
}
} // namespace vtkDistributed
