// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/FlippableMesh.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
/** Degrees. */
constexpr double AngleStep = 1e-6;

TriangleIds GetSortedFacet(const TetrahedronIds& ids, int facet)
{
  return Sorted(GetFacet(ids, facet));
}
} // namespace

AngleKey GetAngleKey(double degrees)
{
  return std::llround(degrees / AngleStep);
}

double FlippableMesh::MeasureAngle(const TetrahedronIds& ids) const
{
  return GetSmallestDihedralAngle(
    this->GetPoint(ids[0]), this->GetPoint(ids[1]), this->GetPoint(ids[2]), this->GetPoint(ids[3]));
}

void FlippableMesh::MeasureAngles(int numberOfThreads)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  this->Angles.resize(count);
  ForEach(count, numberOfThreads,
    [this](std::size_t t) { this->Angles[t] = this->MeasureAngle(this->Mesh.Tetrahedra[t]); });
  this->Stamps.resize(count, 0);
}

double FlippableMesh::GetSmallestAngle() const
{
  return this->Angles.empty() ? 0.0 : *std::min_element(this->Angles.begin(), this->Angles.end());
}

bool FlippableMesh::FindRing(
  Id tetrahedron, int edge, std::size_t maximumSize, EdgeRing& ring) const
{
  const int* order = EdgeVertices[edge];
  const TetrahedronIds& first = this->Mesh.Tetrahedra[tetrahedron];
  ring.P = first[order[0]];
  ring.Q = first[order[1]];
  ring.Points.clear();
  ring.Tetrahedra.clear();
  Id current = tetrahedron;
  // Position of the ring's point that is left behind.
  int last = order[2];
  Id next = first[order[3]];
  do
  {
    if (ring.Tetrahedra.size() == maximumSize)
    {
      return false;
    }
    ring.Tetrahedra.push_back(current);
    ring.Points.push_back(this->Mesh.Tetrahedra[current][last]);
    const Id facet = this->Mesh.Neighbors[current][last];
    if (facet == NoId)
    {
      return false;
    }
    current = facet / 4;
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[current];
    last = static_cast<int>(std::find(ids.begin(), ids.end(), next) - ids.begin());
    next = ids[facet % 4];
  } while (current != tetrahedron);
  return true;
}

bool FlippableMesh::IsInOneRegion(const EdgeRing& ring) const
{
  return std::all_of(ring.Tetrahedra.begin(), ring.Tetrahedra.end(),
    [&](Id other)
    { return this->Mesh.Regions[other] == this->Mesh.Regions[ring.Tetrahedra.front()]; });
}

void FlippableMesh::Schedule(Id tetrahedron)
{
  if (this->Angles[tetrahedron] < this->Target)
  {
    this->Tasks.push({ this->Angles[tetrahedron], tetrahedron, this->Stamps[tetrahedron] });
  }
}

void FlippableMesh::ScheduleAll()
{
  for (Id tetrahedron = 0; tetrahedron < static_cast<Id>(this->Angles.size()); ++tetrahedron)
  {
    if (!this->IsDead(tetrahedron))
    {
      this->Schedule(tetrahedron);
    }
  }
}

Id FlippableMesh::TakeTask()
{
  const Task task = this->Tasks.top();
  this->Tasks.pop();
  return task.Stamp == this->Stamps[task.Tetrahedron] ? task.Tetrahedron : NoId;
}

void FlippableMesh::Kill(Id tetrahedron)
{
  this->Mesh.Tetrahedra[tetrahedron] = { NoId, NoId, NoId, NoId };
  this->Angles[tetrahedron] = 180.0;
  ++this->Stamps[tetrahedron];
  this->Free.push_back(tetrahedron);
}

/** The facets around tetrahedra, with what lies behind them. */
std::vector<FlippableMesh::OpenFacet> FlippableMesh::FindFacetsAround(
  const std::vector<Id>& tetrahedra) const
{
  std::vector<OpenFacet> facets;
  for (const Id tetrahedron : tetrahedra)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      const Id neighbor = this->Mesh.Neighbors[tetrahedron][facet];
      if (neighbor == NoId || !Contains(tetrahedra, neighbor / 4))
      {
        facets.push_back({ GetSortedFacet(this->Mesh.Tetrahedra[tetrahedron], facet), neighbor });
      }
    }
  }
  return facets;
}

/** Makes a tetrahedron in a free slot, without its neighbors. */
Id FlippableMesh::Make(const TetrahedronIds& ids, Id region)
{
  Id tetrahedron = NoId;
  if (this->Free.empty())
  {
    tetrahedron = static_cast<Id>(this->Mesh.Tetrahedra.size());
    this->Mesh.Tetrahedra.emplace_back();
    this->Mesh.Regions.emplace_back();
    this->Mesh.Neighbors.emplace_back();
    this->Angles.emplace_back();
    this->Stamps.emplace_back(0);
  }
  else
  {
    tetrahedron = this->Free.back();
    this->Free.pop_back();
  }
  this->Mesh.Tetrahedra[tetrahedron] = ids;
  this->Mesh.Regions[tetrahedron] = region;
  this->Angles[tetrahedron] = this->MeasureAngle(ids);
  return tetrahedron;
}

/** Connects a new tetrahedron across the facets that are open; its other facets become so. */
void FlippableMesh::Connect(Id tetrahedron, std::vector<OpenFacet>& open)
{
  for (int facet = 0; facet < 4; ++facet)
  {
    const TriangleIds points = GetSortedFacet(this->Mesh.Tetrahedra[tetrahedron], facet);
    const Id own = 4 * tetrahedron + facet;
    const auto found = std::find_if(
      open.begin(), open.end(), [&](const OpenFacet& other) { return other.Points == points; });
    if (found == open.end())
    {
      open.push_back({ points, own });
      continue;
    }
    this->Mesh.Neighbors[tetrahedron][facet] = found->Behind;
    if (found->Behind != NoId)
    {
      this->Mesh.Neighbors[found->Behind / 4][found->Behind % 4] = own;
    }
  }
}

void FlippableMesh::Apply(const Flip& flip)
{
  std::vector<OpenFacet> open = this->FindFacetsAround(flip.Old);
  const std::size_t numberOfOuterFacets = open.size();
  const Id region = this->Mesh.Regions[flip.Old.front()];
  for (auto tetrahedron = flip.Old.rbegin(); tetrahedron != flip.Old.rend(); ++tetrahedron)
  {
    this->Kill(*tetrahedron);
  }
  std::vector<Id> made;
  for (const TetrahedronIds& ids : flip.New)
  {
    made.push_back(this->Make(ids, region));
    this->Connect(made.back(), open);
  }
  for (const Id tetrahedron : made)
  {
    this->Schedule(tetrahedron);
  }
  // For their neighbors flips may have become possible.
  for (std::size_t i = 0; i < numberOfOuterFacets; ++i)
  {
    if (open[i].Behind != NoId)
    {
      this->Schedule(open[i].Behind / 4);
    }
  }
}

void FlippableMesh::Remove(Id tetrahedron)
{
  for (const Id neighbor : this->Mesh.Neighbors[tetrahedron])
  {
    if (neighbor != NoId)
    {
      this->Mesh.Neighbors[neighbor / 4][neighbor % 4] = NoId;
      // Now a facet of the neighbor is on the boundary, and it may be peeled off next.
      this->Schedule(neighbor / 4);
    }
  }
  this->Kill(tetrahedron);
}

void FlippableMesh::MovePoint(Id point, const Vec3& position, const std::vector<Id>& star)
{
  this->Mesh.Points[point] = position;
  for (const Id other : star)
  {
    this->Angles[other] = this->MeasureAngle(this->Mesh.Tetrahedra[other]);
    ++this->Stamps[other];
  }
  for (const Id other : star)
  {
    this->Schedule(other);
    // For their neighbors flips may have become possible.
    for (const Id facet : this->Mesh.Neighbors[other])
    {
      if (facet != NoId && !Contains(star, facet / 4))
      {
        this->Schedule(facet / 4);
      }
    }
  }
}

void FlippableMesh::Compact()
{
  std::size_t count = 0;
  for (std::size_t t = 0; t < this->Angles.size(); ++t)
  {
    if (!this->IsDead(static_cast<Id>(t)))
    {
      this->Angles[count++] = this->Angles[t];
    }
  }
  this->Angles.resize(count);
  this->Stamps.assign(count, 0);
  RemoveDeadTetrahedra(this->Mesh);
}
} // namespace cdm
