// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ChangeableSurface.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Meshes/TriangleIntersection.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdm
{
namespace
{
/** Cosine of the largest bend that a change may make within a facet: 60 degrees. */
constexpr double SmallestBendCosine = 0.5;

Box GetBounds(const std::vector<Vec3>& points)
{
  Box bounds;
  for (const Vec3& point : points)
  {
    bounds.Add(point);
  }
  return bounds;
}

std::vector<BoundSimplex> MakeTriangles(const TriangleMesh& surface, const std::vector<Id>& facets)
{
  std::vector<BoundSimplex> simplices;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    simplices.push_back(
      { { surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]] }, facets[t] });
  }
  return simplices;
}

BoundSimplex MakeSegment(const std::vector<Vec3>& points, const EdgeIds& edge, Id chain)
{
  return { { points[edge[0]], points[edge[1]], points[edge[1]] }, chain };
}

std::vector<BoundSimplex> MakeSegments(
  const std::vector<Vec3>& points, const std::vector<StructuralEdge>& edges)
{
  std::vector<BoundSimplex> simplices;
  for (const StructuralEdge& edge : edges)
  {
    simplices.push_back(MakeSegment(points, edge.Points, edge.Chain));
  }
  return simplices;
}

/** Whether p lies in the closed tetrahedron; false for a flat one. */
bool IsInTetrahedron(const Vec3& p, const std::array<Vec3, 4>& corners)
{
  const auto& [a, b, c, d] = corners;
  const int sign = Orientation(a, b, c, d);
  return sign != 0 && Orientation(a, b, c, p) * sign >= 0 && Orientation(a, b, p, d) * sign >= 0 &&
    Orientation(a, p, c, d) * sign >= 0 && Orientation(p, b, c, d) * sign >= 0;
}

/** Whether a triangle runs from a to b, and not from b to a. */
bool RunsForward(const TriangleIds& ids, Id a, Id b)
{
  return (ids[0] == a && ids[1] == b) || (ids[1] == a && ids[2] == b) ||
    (ids[2] == a && ids[0] == b);
}

Id GetApex(const TriangleIds& ids, const EdgeIds& edge)
{
  return *std::find_if(
    ids.begin(), ids.end(), [&](Id id) { return id != edge[0] && id != edge[1]; });
}
} // namespace

ChangeableSurface::ChangeableSurface(const TriangleMesh& surface, const std::vector<Id>& facets,
  const std::vector<StructuralEdge>& edges, double bound, ThreadTeam& threads)
  : Points(surface.Points), Triangles(surface.Triangles), Facets(facets),
    Uses(surface.Points.size()), EdgesAt(surface.Points.size()),
    Boxes(GetBounds(surface.Points), static_cast<Id>(surface.Triangles.size())),
    FacetBound(MakeTriangles(surface, facets), bound, threads),
    ChainBound(MakeSegments(surface.Points, edges), bound, threads)
{
  const SurfaceSides sides = FindSurfaceSides(surface);
  for (Id t = 0; t < this->GetNumberOfTriangles(); ++t)
  {
    this->Sources.push_back(t);
    this->Spaces.push_back({ sides.Shells[2 * t], sides.Shells[2 * t + 1] });
    this->Boxes.Add(t, GetBox(this->Points, this->Triangles[t]));
    for (const Id point : this->Triangles[t])
    {
      this->Uses[point].push_back(t);
    }
  }
  for (const StructuralEdge& edge : edges)
  {
    for (const Id point : edge.Points)
    {
      this->EdgesAt[point].push_back(static_cast<Id>(this->Edges.size()));
    }
    this->Edges.push_back(edge.Points);
    this->Chains.push_back(edge.Chain);
  }
}

bool ChangeableSurface::Has(Id triangle, Id point) const
{
  return Contains(this->Triangles[triangle], point);
}

std::vector<Id> ChangeableSurface::GetUses(const EdgeIds& edge) const
{
  std::vector<Id> uses;
  for (const Id t : this->Uses[edge[0]])
  {
    if (this->Has(t, edge[1]))
    {
      uses.push_back(t);
    }
  }
  return uses;
}

std::vector<Id> ChangeableSurface::GetNeighbors(Id point) const
{
  std::vector<Id> neighbors;
  for (const Id t : this->Uses[point])
  {
    for (const Id id : this->Triangles[t])
    {
      if (id != point)
      {
        neighbors.push_back(id);
      }
    }
  }
  SortUnique(neighbors);
  return neighbors;
}

Id ChangeableSurface::FindEdge(const EdgeIds& edge) const
{
  for (const Id number : this->EdgesAt[edge[0]])
  {
    if (this->GetOtherEnd(number, edge[0]) == edge[1])
    {
      return number;
    }
  }
  return NoId;
}

bool ChangeableSurface::FindNearestOriginal(
  Id point, const Vec3& position, double reach, Vec3& nearest) const
{
  Id simplex = NoId;
  const std::vector<Id>& edges = this->EdgesAt[point];
  return edges.empty()
    ? this->FacetBound.FindNearest(
        position, this->Facets[this->Uses[point].front()], reach, nearest, simplex)
    : this->ChainBound.FindNearest(position, this->Chains[edges.front()], reach, nearest, simplex);
}

Id ChangeableSurface::FindOriginalTriangle(Id point, double reach, Vec3& nearest) const
{
  Id simplex = NoId;
  this->FacetBound.FindNearest(
    this->Points[point], this->Facets[this->Uses[point].front()], reach, nearest, simplex);
  return simplex;
}

Vec3 ChangeableSurface::GetNormal(const TriangleIds& ids) const
{
  const Vec3 normal =
    GetAreaVector(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  const double length = Norm(normal);
  return length > 0.0 ? (1.0 / length) * normal : normal;
}

double ChangeableSurface::GetBend(const TriangleIds& ids, const TriangleIds& other) const
{
  std::array<Id, 2> common{ NoId, NoId };
  int count = 0;
  for (const Id id : ids)
  {
    if (Contains(other, id) && count < 2)
    {
      common[count++] = id;
    }
  }
  const double cosine = Dot(this->GetNormal(ids), this->GetNormal(other));
  return RunsForward(ids, common[0], common[1]) != RunsForward(other, common[0], common[1])
    ? cosine
    : -cosine;
}

double ChangeableSurface::GetOldBend(const SurfaceChange& change) const
{
  double smallest = SmallestBendCosine;
  for (const Id t : change.Removed)
  {
    const TriangleIds& ids = this->Triangles[t];
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds edge = MakeEdge(ids[i], ids[(i + 1) % 3]);
      if (this->FindEdge(edge) != NoId)
      {
        continue;
      }
      for (const Id other : this->GetUses(edge))
      {
        if (other != t)
        {
          smallest = std::min(smallest, this->GetBend(ids, this->Triangles[other]));
        }
      }
    }
  }
  return smallest;
}

std::vector<ChangeableSurface::Around> ChangeableSurface::FindAround(
  const SurfaceChange& change, const EdgeIds& edge) const
{
  std::vector<Around> around;
  for (const Id t : this->Uses[edge[0]])
  {
    if (this->Has(t, edge[1]) && !Contains(change.Removed, t))
    {
      around.push_back({ this->Triangles[t], t });
    }
  }
  for (const NewTriangle& added : change.Added)
  {
    if (Contains(added.Points, edge[0]) && Contains(added.Points, edge[1]))
    {
      around.push_back({ added.Points, added.Source });
    }
  }
  return around;
}

bool ChangeableSurface::KeepsTopology(Id point, Id target) const
{
  const std::vector<Id> neighbors = this->GetNeighbors(point);
  std::vector<Id> apexes;
  for (const Id t : this->GetUses(EdgeIds{ point, target }))
  {
    apexes.push_back(GetApex(this->Triangles[t], { point, target }));
  }
  const std::size_t count = apexes.size();
  SortUnique(apexes);
  if (apexes.size() != count)
  {
    return false;
  }
  // The link condition for points: common neighbors have a triangle with the edge.
  for (const Id t : this->Uses[target])
  {
    if (this->Has(t, point))
    {
      continue;
    }
    int common = 0;
    for (const Id id : this->Triangles[t])
    {
      if (id == target || !std::binary_search(neighbors.begin(), neighbors.end(), id))
      {
        continue;
      }
      if (!std::binary_search(apexes.begin(), apexes.end(), id))
      {
        return false;
      }
      ++common;
    }
    // And for edges: no triangle of the point becomes equal to one of the target.
    if (common == 2)
    {
      TriangleIds ids = this->Triangles[t];
      std::replace(ids.begin(), ids.end(), target, point);
      for (const Id other : this->Uses[point])
      {
        if (Sorted(this->Triangles[other]) == Sorted(ids))
        {
          return false;
        }
      }
    }
  }
  return true;
}

bool ChangeableSurface::TryChange(const SurfaceChange& change)
{
  std::vector<Vec3> oldNormals;
  for (const NewTriangle& added : change.Added)
  {
    oldNormals.push_back(this->GetNormal(this->Triangles[added.Source]));
  }
  const double oldBend = this->GetOldBend(change);
  const bool isNew = change.Point == this->GetNewPoint();
  Vec3 oldPosition;
  if (isNew)
  {
    this->Points.push_back(change.Position);
    this->Uses.emplace_back();
    this->EdgesAt.emplace_back();
  }
  else if (change.Point != NoId)
  {
    oldPosition = std::exchange(this->Points[change.Point], change.Position);
  }
  if (this->KeepsAll(change, oldNormals, oldBend))
  {
    this->Commit(change);
    return true;
  }
  if (isNew)
  {
    this->Points.pop_back();
    this->Uses.pop_back();
    this->EdgesAt.pop_back();
  }
  else if (change.Point != NoId)
  {
    this->Points[change.Point] = oldPosition;
  }
  return false;
}

bool ChangeableSurface::KeepsAll(
  const SurfaceChange& change, const std::vector<Vec3>& oldNormals, double oldBend)
{
  double smallestCosine = oldBend;
  for (std::size_t i = 0; i < change.Added.size(); ++i)
  {
    const TriangleIds& ids = change.Added[i].Points;
    if (AreCollinear(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]))
    {
      return false;
    }
    // What turns far may fold over: not if it follows its neighbors.
    if (!(Dot(this->GetNormal(ids), oldNormals[i]) >= SmallestBendCosine))
    {
      smallestCosine = SmallestBendCosine;
    }
  }
  return this->KeepsBends(change, smallestCosine) && this->MeetsNothing(change) &&
    this->KeepsSpaces(change) && this->KeepsBound(change);
}

bool ChangeableSurface::KeepsBends(const SurfaceChange& change, double smallestCosine) const
{
  for (const NewTriangle& added : change.Added)
  {
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds edge = MakeEdge(added.Points[i], added.Points[(i + 1) % 3]);
      if (this->FindEdge(edge) != NoId || Contains(change.AddedEdges, edge))
      {
        continue;
      }
      const std::vector<Around> around = this->FindAround(change, edge);
      if (around.size() != 2 || this->GetBend(around[0].Ids, around[1].Ids) < smallestCosine)
      {
        return false;
      }
    }
  }
  return true;
}

bool ChangeableSurface::MeetsNothing(const SurfaceChange& change) const
{
  Box region;
  std::vector<Box> boxes;
  for (const NewTriangle& added : change.Added)
  {
    boxes.push_back(GetBox(this->Points, added.Points));
    region.Add(boxes.back());
  }
  for (const std::array<Vec3, 4>& corners : change.Swept)
  {
    for (const Vec3& corner : corners)
    {
      region.Add(corner);
    }
  }
  const auto meets = [&](const TriangleIds& ids, const Box& box, std::size_t i)
  {
    return boxes[i].Overlaps(box) &&
      ClassifyTriangles(this->Points, ids, change.Added[i].Points) == TriangleContact::Intersection;
  };
  std::vector<Id> near;
  this->Boxes.Find(region, near);
  for (const Id t : near)
  {
    if (Contains(change.Removed, t))
    {
      continue;
    }
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      if (meets(this->Triangles[t], this->Boxes.GetBox(t), i))
      {
        return false;
      }
    }
    if (this->IsPassedOver(t, change))
    {
      return false;
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (meets(change.Added[j].Points, boxes[j], i))
      {
        return false;
      }
    }
  }
  return true;
}

/** Whether a triangle that stays lies between the old and the new ones. */
bool ChangeableSurface::IsPassedOver(Id triangle, const SurfaceChange& change) const
{
  const auto isIn = [&](const Vec3& p)
  {
    return std::any_of(change.Swept.begin(), change.Swept.end(),
      [&p](const std::array<Vec3, 4>& corners) { return IsInTetrahedron(p, corners); });
  };
  int common = 0;
  for (const Id id : this->Triangles[triangle])
  {
    const auto has = [id](const NewTriangle& added) { return Contains(added.Points, id); };
    if (std::any_of(change.Added.begin(), change.Added.end(), has))
    {
      ++common;
    }
    else if (isIn(this->Points[id]))
    {
      return true;
    }
  }
  // With all its points on the border it lies on one side, as a whole.
  const std::array<Vec3, 3> corners = this->GetCorners(this->Triangles[triangle]);
  return common == 3 && isIn((1.0 / 3.0) * (corners[0] + corners[1] + corners[2]));
}

/** Whether around edges of three or more triangles each space borders on itself only. */
bool ChangeableSurface::KeepsSpaces(const SurfaceChange& change) const
{
  for (const NewTriangle& added : change.Added)
  {
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds edge = MakeEdge(added.Points[i], added.Points[(i + 1) % 3]);
      const std::vector<Around> triangles = this->FindAround(change, edge);
      if (triangles.size() < 3)
      {
        continue;
      }
      std::vector<TriangleAtEdge> around;
      for (const Around& triangle : triangles)
      {
        around.push_back({ edge, triangle.Source, GetApex(triangle.Ids, edge),
          RunsForward(triangle.Ids, edge[0], edge[1]) });
      }
      SortAroundEdge(this->Points, around.data(), around.data() + around.size());
      for (std::size_t j = 0; j < around.size(); ++j)
      {
        const TriangleAtEdge& next = around[(j + 1) % around.size()];
        const RegionPair& spaces = this->Spaces[around[j].Triangle];
        const RegionPair& nextSpaces = this->Spaces[next.Triangle];
        if ((around[j].IsForward ? spaces.Front : spaces.Back) !=
          (next.IsForward ? nextSpaces.Back : nextSpaces.Front))
        {
          return false;
        }
      }
    }
  }
  return true;
}

bool ChangeableSurface::KeepsBound(const SurfaceChange& change)
{
  this->ChainChange = {};
  this->ChainChange.Removed = change.RemovedEdges;
  for (const EdgeIds& edge : change.AddedEdges)
  {
    this->ChainChange.Added.push_back(
      MakeSegment(this->Points, edge, this->Chains[change.RemovedEdges.front()]));
  }
  this->FacetChange = {};
  this->FacetChange.Removed = change.Removed;
  for (const NewTriangle& added : change.Added)
  {
    this->FacetChange.Added.push_back(
      { this->GetCorners(added.Points), this->Facets[added.Source] });
    for (const Id point : added.Points)
    {
      this->FacetChange.Neighbors.insert(
        this->FacetChange.Neighbors.end(), this->Uses[point].begin(), this->Uses[point].end());
    }
  }
  if (!this->ChainBound.Prove(this->ChainChange, this->ChainProof))
  {
    return false;
  }
  // Facets end at chains.
  this->FacetChange.BorderShift = this->ChainProof.IsShift ? this->ChainProof.Shift : Infinity;
  return this->FacetBound.Prove(this->FacetChange, this->FacetProof);
}

void ChangeableSurface::Commit(const SurfaceChange& change)
{
  // New triangles take the ids of those that go; the rest of either list comes last.
  std::vector<Id> ids;
  struct Origin
  {
    Id Facet;
    Id Source;
    RegionPair Spaces;
  };
  std::vector<Origin> origins;
  for (const NewTriangle& added : change.Added)
  {
    const Id t = added.Source;
    origins.push_back({ this->Facets[t], this->Sources[t], this->Spaces[t] });
  }
  for (const Id t : change.Removed)
  {
    this->Boxes.Remove(t);
    this->Sources[t] = NoId;
    for (const Id point : this->Triangles[t])
    {
      std::vector<Id>& uses = this->Uses[point];
      uses.erase(std::find(uses.begin(), uses.end(), t));
    }
  }
  for (std::size_t i = 0; i < change.Added.size(); ++i)
  {
    Id t = NoId;
    if (i < change.Removed.size())
    {
      t = change.Removed[i];
    }
    else
    {
      t = this->GetNumberOfTriangles();
      this->Triangles.emplace_back();
      this->Facets.push_back(NoId);
      this->Sources.push_back(NoId);
      this->Spaces.emplace_back();
    }
    this->Triangles[t] = change.Added[i].Points;
    this->Facets[t] = origins[i].Facet;
    this->Sources[t] = origins[i].Source;
    this->Spaces[t] = origins[i].Spaces;
    this->Boxes.Add(t, GetBox(this->Points, this->Triangles[t]));
    for (const Id point : this->Triangles[t])
    {
      this->Uses[point].push_back(t);
    }
    ids.push_back(t);
  }
  this->FacetBound.Replace(this->FacetChange, ids, this->FacetProof);
  this->CommitEdges(change);
}

void ChangeableSurface::CommitEdges(const SurfaceChange& change)
{
  std::vector<Id> ids;
  for (const Id edge : change.RemovedEdges)
  {
    for (const Id point : this->Edges[edge])
    {
      std::vector<Id>& edges = this->EdgesAt[point];
      edges.erase(std::find(edges.begin(), edges.end(), edge));
    }
  }
  for (std::size_t i = 0; i < change.AddedEdges.size(); ++i)
  {
    const Id chain = this->Chains[change.RemovedEdges.front()];
    if (i < change.RemovedEdges.size())
    {
      ids.push_back(change.RemovedEdges[i]);
    }
    else
    {
      ids.push_back(static_cast<Id>(this->Edges.size()));
      this->Edges.emplace_back();
      this->Chains.push_back(chain);
    }
    this->Edges[ids.back()] = change.AddedEdges[i];
    for (const Id point : change.AddedEdges[i])
    {
      this->EdgesAt[point].push_back(ids.back());
    }
  }
  this->ChainBound.Replace(this->ChainChange, ids, this->ChainProof);
}
} // namespace cdm
