// SPDX-License-Identifier: BSD-3-Clause
#include "AdvancingFrontTetrahedralizer.h"

#include "CosphericalCell.h"
#include "FacetTable.h"
#include "FourthPointSearch.h"
#include "Predicates.h"
#include "SurfaceDelaunayTest.h"
#include "SurfaceSides.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

namespace cdm
{
namespace
{
/** Facet ids of 4 * tetrahedron + i have to fit into an Id. */
constexpr std::size_t MaximumTetrahedra = std::size_t(1) << 29;

/** How often the context is asked, in tetrahedra or triangles. */
constexpr std::size_t ReportInterval = 4096;

void SortUnique(std::vector<Id>& ids)
{
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/** +1 if two orders of the same three points turn the same way, else -1. */
int GetRelativeTurn(const TriangleIds& s, const TriangleIds& t)
{
  const int first = s[0] == t[0] ? 0 : s[0] == t[1] ? 1 : 2;
  return s[1] == t[(first + 1) % 3] ? 1 : -1;
}

class AdvancingFront
{
public:
  AdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
    const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
    AdvancingFrontTetrahedralizerOutput& output)
    : Input(input)
    , Options(options)
    , Context(context)
    , Output(output)
    , Surface(output.Boundary)
    , Points(output.Mesh.Points)
    , Mesh(output.Mesh)
    , Search(Points, Octree)
    , Cell(Points)
  {
  }

  Status Run();

private:
  Status CollectPoints();
  Status TurnDiagonals();
  Status FindSeeds();
  bool LocateSeed(const Vec3& position, Id& side) const;
  Status GrowRegion(Id side, Id region);
  Status CompleteFacet(const TriangleIds& base, Id region, Id sourceFacet);
  Status AddTetrahedron(const TetrahedronIds& tetrahedron, Id region);
  Status AttachToSurface(Id triangle, const TriangleIds& outward, Id facet, Id region);
  void AddHullTriangle(const TriangleIds& outward, Id facet, Id region);
  void Finish();
  void SortTetrahedra();
  TriangleIds GetSideTriangle(Id side) const
  {
    const TriangleIds& t = this->Surface.Triangles[side / 2];
    return side % 2 == 0 ? t : TriangleIds{ t[0], t[2], t[1] };
  }
  Id GetSideLabel(Id side) const
  {
    const RegionPair& labels = this->Surface.Labels[side / 2];
    return side % 2 == 0 ? labels.Front : labels.Back;
  }
  /** Cell of the stage's input that a surface triangle stands for. */
  Id GetSourceCell(Id triangle) const { return this->Surface.SourceCells[triangle]; }
  bool IsLimitReached() const
  {
    return this->Options.MaximumNumberOfTetrahedra > 0 &&
      static_cast<Id>(this->Mesh.Tetrahedra.size()) >= this->Options.MaximumNumberOfTetrahedra;
  }

  const AdvancingFrontTetrahedralizerInput& Input;
  const AdvancingFrontTetrahedralizerOptions& Options;
  const ExecutionContext& Context;
  AdvancingFrontTetrahedralizerOutput& Output;

  /** Works on the output's boundary: the surface, then triangles that close open borders. */
  TriangleMesh& Surface;
  std::vector<Vec3>& Points;
  TetMesh& Mesh;
  bool HasLabels = false;
  Id NumberOfSurfacePoints = 0;
  Id NumberOfSurfaceTriangles = 0;
  PointOctree Octree;
  FourthPointSearch Search;
  CosphericalCell Cell;
  FourthPoint Found;

  /** For each side of the surface: the tetrahedron facet attached to it, or NoId. */
  std::vector<Id> SideFacets;
  /** Region that the front reached the side with. */
  std::vector<Id> SideRegions;
  std::vector<std::pair<Id, Id>> Seeds; // side, region
  /** Open facets of the front by their points; surface triangle t is stored as -2 - t. */
  FacetTable Facets;
  std::vector<Id> Queue;
  bool IsStopped = false;
};

Status AdvancingFront::CollectPoints()
{
  const TriangleMesh& surface = *this->Input.Surface;
  this->Surface = surface;
  this->HasLabels = !surface.Labels.empty();
  this->Surface.SourceCells.resize(surface.Triangles.size());
  std::iota(this->Surface.SourceCells.begin(), this->Surface.SourceCells.end(), 0);
  this->NumberOfSurfaceTriangles = static_cast<Id>(surface.Triangles.size());
  this->NumberOfSurfacePoints = static_cast<Id>(surface.Points.size());

  this->Points = std::move(this->Surface.Points);
  this->Surface.Points.clear();
  std::vector<Id> meshPoints;
  if (this->Input.MeshPoints != nullptr)
  {
    meshPoints.resize(this->Input.MeshPoints->size());
    std::iota(meshPoints.begin(), meshPoints.end(), 0);
    this->Points.insert(
      this->Points.end(), this->Input.MeshPoints->begin(), this->Input.MeshPoints->end());
  }
  if (surface.Triangles.empty())
  {
    return Status::InvalidInput("The surface has no triangles; there is nothing to mesh.");
  }
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    if (!IsFinite(this->Points[i]))
    {
      const bool isMeshPoint = static_cast<Id>(i) >= this->NumberOfSurfacePoints;
      return Status::InvalidInput(isMeshPoint
          ? "A mesh point has a coordinate that is not a finite number; remove it."
          : "A point has a coordinate that is not a finite number; remove or repair it.",
        {}, { static_cast<Id>(i) - (isMeshPoint ? this->NumberOfSurfacePoints : 0) });
    }
  }
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    if (AreCollinear(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]))
    {
      return Status::InvalidInput("A triangle of the surface has no area; clean the surface with "
                                  "vtkBoundaryTriangulator first.",
        { t });
    }
  }

  // Copies of a point cannot be told apart: they are an error on the surface, and left out
  // among the mesh points. The lower number wins.
  std::vector<Id> order(this->Points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [this](Id i, Id j) {
    return this->Points[i] != this->Points[j] ? this->Points[i] < this->Points[j] : i < j;
  });
  std::vector<char> isCopy(this->Points.size(), 0);
  std::vector<Id> coincident;
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (this->Points[order[i]] == this->Points[order[i - 1]])
    {
      isCopy[order[i]] = 1;
      if (order[i] < this->NumberOfSurfacePoints)
      {
        coincident.push_back(order[i - 1]);
        coincident.push_back(order[i]);
      }
    }
  }
  if (!coincident.empty())
  {
    SortUnique(coincident);
    return Status::InvalidInput("Points of the surface coincide; merge them with "
                                "vtkBoundaryTriangulator first.",
      {}, std::move(coincident));
  }
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    if (!isCopy[i])
    {
      this->Octree.Insert(static_cast<Id>(i), this->Points[i]);
    }
  }
  return Status();
}

/**
 * Triangles of the flat facet around a triangle whose circumcircle holds all given points: crosses
 * an edge of two triangles with the same labels if the point beyond is one of them.
 */
class FacetPolygons
{
public:
  FacetPolygons(const TriangleMesh& surface, bool hasLabels)
    : Surface(surface)
    , HasLabels(hasLabels)
  {
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      for (int i = 0; i < 3; ++i)
      {
        const Id a = surface.Triangles[t][i];
        const Id b = surface.Triangles[t][(i + 1) % 3];
        this->Uses.push_back({ { std::min(a, b), std::max(a, b) }, static_cast<Id>(t) });
      }
    }
    std::sort(this->Uses.begin(), this->Uses.end());
  }

  /** False if not all of the cocircular points are reached. */
  bool Collect(Id start, const std::vector<Id>& cocircular, std::vector<Id>& triangles) const
  {
    triangles.assign(1, start);
    std::vector<Id> reached;
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      const TriangleIds& ids = this->Surface.Triangles[triangles[i]];
      for (int e = 0; e < 3; ++e)
      {
        const Id a = ids[e];
        const Id b = ids[(e + 1) % 3];
        const Id other = this->GetOther(triangles[i], a, b);
        if (other == NoId || !this->HaveSameLabels(triangles[i], other, a, b) ||
          std::find(triangles.begin(), triangles.end(), other) != triangles.end())
        {
          continue;
        }
        const TriangleIds& beyond = this->Surface.Triangles[other];
        const Id apex = beyond[0] != a && beyond[0] != b ? beyond[0]
          : beyond[1] != a && beyond[1] != b             ? beyond[1]
                                                         : beyond[2];
        if (std::binary_search(cocircular.begin(), cocircular.end(), apex))
        {
          triangles.push_back(other);
          reached.push_back(apex);
        }
      }
    }
    SortUnique(reached);
    return reached == cocircular;
  }

private:
  /** The other triangle at the edge, or NoId if there is not exactly one. */
  Id GetOther(Id triangle, Id a, Id b) const
  {
    const std::pair<EdgeIds, Id> key{ { std::min(a, b), std::max(a, b) }, 0 };
    const auto first = std::lower_bound(this->Uses.begin(), this->Uses.end(), key);
    auto last = first;
    while (last != this->Uses.end() && last->first == key.first)
    {
      ++last;
    }
    return last - first != 2 ? NoId
      : first->second == triangle ? (first + 1)->second
                                  : first->second;
  }

  bool HaveSameLabels(Id s, Id t, Id a, Id b) const
  {
    if (!this->HasLabels)
    {
      return true;
    }
    const auto runs = [a, b](const TriangleIds& ids) {
      return (ids[0] == a && ids[1] == b) || (ids[1] == a && ids[2] == b) ||
        (ids[2] == a && ids[0] == b);
    };
    RegionPair labels = this->Surface.Labels[t];
    if (runs(this->Surface.Triangles[s]) == runs(this->Surface.Triangles[t]))
    {
      std::swap(labels.Front, labels.Back);
    }
    return this->Surface.Labels[s] == labels;
  }

  const TriangleMesh& Surface;
  bool HasLabels;
  std::vector<std::pair<EdgeIds, Id>> Uses;
};

Status AdvancingFront::TurnDiagonals()
{
  const FacetPolygons polygons(this->Surface, this->HasLabels);
  SurfaceDelaunayTest test(this->Points, this->Octree);
  SurfaceDelaunayTest::Result result;
  std::vector<Id> offending;
  std::vector<char> isDone(this->Surface.Triangles.size(), 0);
  std::vector<Id> polygonTriangles;
  const ExecutionContext part = this->Context.Part(0.0, 0.1);
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    if (t % ReportInterval == 0 &&
      !part.Continue(double(t) / this->NumberOfSurfaceTriangles, "Checking the surface"))
    {
      return Status::Aborted();
    }
    if (isDone[t])
    {
      continue;
    }
    test.Run(this->Surface.Triangles[t], result);
    if (!result.IsDelaunay ||
      (!result.Cocircular.empty() && !polygons.Collect(t, result.Cocircular, polygonTriangles)))
    {
      offending.push_back(t);
      continue;
    }
    if (result.Cocircular.empty())
    {
      continue;
    }

    // Walk around the polygon: its outline is made of the edges used once.
    const TriangleIds& first = this->Surface.Triangles[t];
    const Vec3& a = this->Points[first[0]];
    std::vector<Id> outline(result.Cocircular);
    outline.insert(outline.end(), first.begin() + 1, first.end());
    // Directions from the first point in the plane of the triangle, in its projection.
    int axis = 0;
    while (ProjectedOrientation(axis, a, this->Points[first[1]], this->Points[first[2]]) == 0)
    {
      ++axis;
    }
    const int turn =
      ProjectedOrientation(axis, a, this->Points[first[1]], this->Points[first[2]]);
    std::sort(outline.begin(), outline.end(), [&](Id x, Id y) {
      return ProjectedOrientation(axis, a, this->Points[x], this->Points[y]) == turn;
    });
    outline.insert(outline.begin(), first[0]);
    std::vector<TriangleIds> fan;
    AppendFan(outline, fan);
    if (fan.size() != polygonTriangles.size())
    {
      return Status::InvalidInput("Triangles of a flat facet overlap; check the surface with "
                                  "vtkBoundaryTriangulator.",
        polygonTriangles);
    }
    const RegionPair labels = this->HasLabels ? this->Surface.Labels[t] : RegionPair{};
    for (std::size_t i = 0; i < fan.size(); ++i)
    {
      const Id triangle = polygonTriangles[i];
      TriangleIds before = this->Surface.Triangles[triangle];
      TriangleIds after = fan[i];
      std::sort(before.begin(), before.end());
      std::sort(after.begin(), after.end());
      this->Output.Report.TurnedDiagonals += before != after;
      this->Surface.Triangles[triangle] = fan[i];
      if (this->HasLabels)
      {
        this->Surface.Labels[triangle] = labels;
      }
      isDone[triangle] = 1;
    }
  }
  if (!offending.empty())
  {
    const std::string count = std::to_string(offending.size());
    return Status::InvalidInput(count +
        " triangles of the surface are not strongly Delaunay; refine the surface with "
        "vtkDelaunaySurfaceRefiner first (mesh points on its second port, if there are any).",
      std::move(offending));
  }
  return Status();
}

bool AdvancingFront::LocateSeed(const Vec3& position, Id& side) const
{
  // Look at the centroid of some triangle: the first triangle met on the way faces the seed.
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 target;
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    const Vec3 centroid = (1.0 / 3.0) *
      (this->Points[ids[0]] + this->Points[ids[1]] + this->Points[ids[2]]);
    const double distance = Distance(centroid, position);
    if (distance < nearest)
    {
      nearest = distance;
      target = centroid;
    }
  }
  double first = std::numeric_limits<double>::infinity();
  side = NoId;
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    const Vec3& a = this->Points[ids[0]];
    const Vec3& b = this->Points[ids[1]];
    const Vec3& c = this->Points[ids[2]];
    const int facing = Orientation(a, b, c, position);
    const int turns[3] = { Orientation(position, a, b, target), Orientation(position, b, c, target),
      Orientation(position, c, a, target) };
    const bool isHit = (turns[0] >= 0 && turns[1] >= 0 && turns[2] >= 0) ||
      (turns[0] <= 0 && turns[1] <= 0 && turns[2] <= 0);
    if (facing == 0 || !isHit)
    {
      continue;
    }
    const Vec3 normal = Cross(b - a, c - a);
    const double way = Dot(normal, a - position) / Dot(normal, target - position);
    if (way > 0.0 && way < first)
    {
      first = way;
      side = 2 * t + (facing > 0 ? 0 : 1);
    }
  }
  return side != NoId;
}

Status AdvancingFront::FindSeeds()
{
  if (this->Input.Seeds != nullptr && !this->Input.Seeds->empty())
  {
    for (const RegionSeed& seed : *this->Input.Seeds)
    {
      Id side = NoId;
      if (!IsFinite(seed.Position) || !this->LocateSeed(seed.Position, side))
      {
        return Status::InvalidInput("A region seed faces no triangle of the surface; move it into "
                                    "the region that it is to mark.",
          {}, { static_cast<Id>(&seed - this->Input.Seeds->data()) });
      }
      this->Seeds.emplace_back(side, seed.Region);
    }
    return Status();
  }
  if (this->HasLabels)
  {
    for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
    {
      if (this->GetSideLabel(side) != OutsideRegion)
      {
        this->Seeds.emplace_back(side, this->GetSideLabel(side));
      }
    }
    if (this->Seeds.empty())
    {
      return Status::InvalidInput(
        "All BoundaryLabels are -1 (outside): no region is left to be meshed.");
    }
    return Status();
  }
  const TriangleMesh withPoints{ this->Points, this->Surface.Triangles, {}, {} };
  const SurfaceSides sides = FindSurfaceSides(withPoints);
  std::vector<char> isSeeded(sides.IsOuter.size(), 0);
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id shell = sides.Shells[side];
    const bool isMeshed =
      !sides.IsOuter[shell] || (this->Options.CloseOpenBoundary && sides.IsOpen[shell]);
    if (isMeshed && !isSeeded[shell])
    {
      isSeeded[shell] = 1;
      this->Seeds.emplace_back(side, NoId);
    }
  }
  if (this->Seeds.empty())
  {
    return Status::InvalidInput("The surface encloses nothing: it has " +
        std::to_string(sides.OpenTriangles.size()) +
        " triangles with an open edge. Close it (MaximumGapEdges of vtkBoundaryTriangulator patches "
        "gaps), or switch CloseOpenBoundary on to mesh up to the convex hull.",
      sides.OpenTriangles);
  }
  return Status();
}

Status AdvancingFront::AttachToSurface(
  Id triangle, const TriangleIds& outward, Id facet, Id region)
{
  // The tetrahedron lies behind its outward facet.
  const bool isFront = GetRelativeTurn(this->Surface.Triangles[triangle], outward) < 0;
  const Id side = 2 * triangle + (isFront ? 0 : 1);
  if (this->SideFacets[side] != NoId)
  {
    return Status::InternalError("Two tetrahedra lie on the same side of a boundary triangle.",
      { this->GetSourceCell(triangle) });
  }
  if (this->HasLabels && triangle < this->NumberOfSurfaceTriangles &&
    (this->Input.Seeds == nullptr || this->Input.Seeds->empty()) &&
    this->GetSideLabel(side) != region)
  {
    return Status::InvalidInput("Region " + std::to_string(region) +
        " is not closed, or its BoundaryLabels contradict each other: it reaches a triangle whose "
        "label on that side is " +
        std::to_string(this->GetSideLabel(side)) + ".",
      { this->GetSourceCell(triangle) });
  }
  this->SideFacets[side] = facet;
  this->SideRegions[side] = region;
  const Id other = this->SideFacets[side ^ 1];
  if (other != NoId)
  {
    this->Mesh.Neighbors[facet / 4][facet % 4] = other;
    this->Mesh.Neighbors[other / 4][other % 4] = facet;
  }
  return Status();
}

void AdvancingFront::AddHullTriangle(const TriangleIds& outward, Id facet, Id region)
{
  const Id triangle = static_cast<Id>(this->Surface.Triangles.size());
  this->Surface.Triangles.push_back(outward);
  this->Surface.SourceCells.push_back(NoId);
  if (this->HasLabels)
  {
    this->Surface.Labels.push_back({ OutsideRegion, region });
  }
  this->SideFacets.resize(2 * this->Surface.Triangles.size(), NoId);
  this->SideRegions.resize(2 * this->Surface.Triangles.size(), OutsideRegion);
  this->SideFacets[2 * triangle + 1] = facet;
  this->SideRegions[2 * triangle + 1] = region;
  this->Facets.Remove(outward);
  this->Facets.Insert(outward, -2 - triangle);
}

Status AdvancingFront::AddTetrahedron(const TetrahedronIds& tetrahedron, Id region)
{
  if (this->Mesh.Tetrahedra.size() >= MaximumTetrahedra)
  {
    return Status::InvalidInput(
      "The mesh needs more than 536870912 tetrahedra, which 32-bit facet ids cannot number.");
  }
  const Id index = static_cast<Id>(this->Mesh.Tetrahedra.size());
  this->Mesh.Tetrahedra.push_back(tetrahedron);
  this->Mesh.Regions.push_back(region);
  this->Mesh.Neighbors.push_back({ NoId, NoId, NoId, NoId });
  for (int i = 0; i < 4; ++i)
  {
    const Id facet = 4 * index + i;
    const TriangleIds outward = GetFacet(tetrahedron, i);
    Id* found = this->Facets.Find(outward);
    if (found == nullptr)
    {
      this->Facets.Insert(outward, facet);
      this->Queue.push_back(facet);
      continue;
    }
    if (*found <= -2)
    {
      const Status status = this->AttachToSurface(-2 - *found, outward, facet, region);
      if (!status.IsOk())
      {
        return status;
      }
      continue;
    }
    const Id other = *found;
    const TriangleIds facing = GetFacet(this->Mesh.Tetrahedra[other / 4], other % 4);
    if (GetRelativeTurn(outward, facing) > 0)
    {
      return Status::InternalError("The front ran into itself: tetrahedra overlap.", {},
        { outward[0], outward[1], outward[2] });
    }
    this->Mesh.Neighbors[index][i] = other;
    this->Mesh.Neighbors[other / 4][other % 4] = facet;
    this->Facets.Remove(outward);
  }
  return Status();
}

Status AdvancingFront::CompleteFacet(const TriangleIds& base, Id region, Id sourceFacet)
{
  this->Search.Find(base, this->Found);
  if (this->Found.Point == NoId)
  {
    if (sourceFacet != NoId && this->Options.CloseOpenBoundary)
    {
      this->AddHullTriangle(base, sourceFacet, region);
      return Status();
    }
    return Status::InvalidInput("Region " + std::to_string(region) +
        " is not closed: the front reached the convex hull of the points. Close the surface, correct "
        "its BoundaryLabels, or switch CloseOpenBoundary on.",
      {}, { base[0], base[1], base[2] });
  }
  if (this->Found.Cospherical.size() == 1 && this->Found.Cocircular.empty())
  {
    return this->AddTetrahedron({ base[0], base[1], base[2], this->Found.Point }, region);
  }
  std::vector<Id> ids(this->Found.Cospherical);
  ids.insert(ids.end(), this->Found.Cocircular.begin(), this->Found.Cocircular.end());
  ids.insert(ids.end(), base.begin(), base.end());
  std::vector<TetrahedronIds> tetrahedra;
  if (!this->Cell.Split(base, ids, tetrahedra))
  {
    return Status::InternalError("A set of cospherical points has no convex hull.", {}, ids);
  }
  ++this->Output.Report.CosphericalCells;
  this->Output.Report.LargestCell =
    std::max(this->Output.Report.LargestCell, static_cast<Id>(ids.size()));
  for (const TetrahedronIds& tetrahedron : tetrahedra)
  {
    const Status status = this->AddTetrahedron(tetrahedron, region);
    if (!status.IsOk())
    {
      return status;
    }
  }
  return Status();
}

Status AdvancingFront::GrowRegion(Id side, Id region)
{
  Status status = this->CompleteFacet(this->GetSideTriangle(side), region, NoId);
  if (!status.IsOk())
  {
    if (status.Cells.empty() && status.Code == StatusCode::InvalidInput)
    {
      status.Cells.push_back(this->GetSourceCell(side / 2));
    }
    return status;
  }
  if (this->SideFacets[side] == NoId)
  {
    return Status::InternalError(
      "A boundary triangle is no facet of the mesh.", { this->GetSourceCell(side / 2) });
  }
  // About 6.7 tetrahedra per point are usual.
  const double expected = 6.7 * static_cast<double>(this->Points.size());
  std::size_t steps = 0;
  while (!this->Queue.empty())
  {
    if (this->IsLimitReached())
    {
      this->IsStopped = true;
      return Status();
    }
    if (++steps % ReportInterval == 0)
    {
      const double done = static_cast<double>(this->Mesh.Tetrahedra.size()) / expected;
      if (!this->Context.Part(0.1, 0.95).Continue(std::min(done, 0.99), "Advancing the front"))
      {
        return Status::Aborted();
      }
    }
    const Id facet = this->Queue.back();
    this->Queue.pop_back();
    if (this->Mesh.Neighbors[facet / 4][facet % 4] != NoId)
    {
      continue;
    }
    status = this->CompleteFacet(
      GetFacet(this->Mesh.Tetrahedra[facet / 4], facet % 4), region, facet);
    if (!status.IsOk())
    {
      return status;
    }
  }
  return Status();
}

void AdvancingFront::SortTetrahedra()
{
  // A numbering that depends on the tetrahedra alone: lowest point first, second lowest second as
  // far as the orientation allows, then by region and points.
  TetMesh& mesh = this->Mesh;
  const std::size_t count = mesh.Tetrahedra.size();
  for (std::size_t t = 0; t < count; ++t)
  {
    TetrahedronIds& ids = mesh.Tetrahedra[t];
    // The even permutations that bring each vertex to the front.
    static constexpr int First[4][4] = { { 0, 1, 2, 3 }, { 1, 0, 3, 2 }, { 2, 0, 1, 3 },
      { 3, 0, 2, 1 } };
    const int lowest = static_cast<int>(std::min_element(ids.begin(), ids.end()) - ids.begin());
    int order[4];
    std::copy(First[lowest], First[lowest] + 4, order);
    const int second = static_cast<int>(
      std::min_element(order + 1, order + 4, [&](int i, int j) { return ids[i] < ids[j]; }) -
      order);
    std::rotate(order + 1, order + second, order + 4);
    const TetrahedronIds oldIds = ids;
    const TetrahedronIds oldNeighbors = mesh.Neighbors[t];
    for (int i = 0; i < 4; ++i)
    {
      ids[i] = oldIds[order[i]];
      const Id neighbor = oldNeighbors[order[i]];
      mesh.Neighbors[t][i] = neighbor == NoId ? NoId : neighbor / 4;
    }
  }
  std::vector<Id> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&mesh](Id i, Id j) {
    return mesh.Regions[i] != mesh.Regions[j] ? mesh.Regions[i] < mesh.Regions[j]
                                              : mesh.Tetrahedra[i] < mesh.Tetrahedra[j];
  });
  std::vector<Id> places(count);
  TetMesh sorted;
  sorted.Points = std::move(mesh.Points);
  sorted.Tetrahedra.resize(count);
  sorted.Regions.resize(count);
  sorted.Neighbors.resize(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    places[order[i]] = static_cast<Id>(i);
    sorted.Tetrahedra[i] = mesh.Tetrahedra[order[i]];
    sorted.Regions[i] = mesh.Regions[order[i]];
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    for (int f = 0; f < 4; ++f)
    {
      const Id old = mesh.Neighbors[order[i]][f];
      if (old == NoId)
      {
        sorted.Neighbors[i][f] = NoId;
        continue;
      }
      // The neighbour's facet is opposite to its one vertex that this facet lacks.
      const Id neighbor = places[old];
      const TriangleIds facet = GetFacet(sorted.Tetrahedra[i], f);
      int opposite = 0;
      while (std::find(facet.begin(), facet.end(), sorted.Tetrahedra[neighbor][opposite]) !=
        facet.end())
      {
        ++opposite;
      }
      sorted.Neighbors[i][f] = 4 * neighbor + opposite;
    }
  }
  mesh = std::move(sorted);
}

void AdvancingFront::Finish()
{
  // Front: facets whose other side is neither meshed nor surface.
  for (std::size_t t = 0; t < this->Mesh.Tetrahedra.size(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds outward = GetFacet(this->Mesh.Tetrahedra[t], i);
      if (this->Mesh.Neighbors[t][i] != NoId)
      {
        continue;
      }
      const Id* found = this->Facets.Find(outward);
      if (found != nullptr && *found >= 0)
      {
        this->Output.Front.push_back(outward);
      }
    }
  }

  // Only mesh points that are used stay.
  std::vector<Id> places(this->Points.size(), NoId);
  for (const TetrahedronIds& ids : this->Mesh.Tetrahedra)
  {
    for (Id id : ids)
    {
      places[id] = 0;
    }
  }
  Id count = this->NumberOfSurfacePoints;
  for (Id i = 0; i < static_cast<Id>(places.size()); ++i)
  {
    if (i < this->NumberOfSurfacePoints)
    {
      places[i] = i;
    }
    else if (places[i] != NoId)
    {
      this->Output.MeshPointSources.push_back(i - this->NumberOfSurfacePoints);
      this->Points[count] = this->Points[i];
      places[i] = count++;
    }
    else
    {
      ++this->Output.Report.UnusedMeshPoints;
    }
  }
  this->Points.resize(count);
  for (TetrahedronIds& ids : this->Mesh.Tetrahedra)
  {
    for (Id& id : ids)
    {
      id = places[id];
    }
  }
  for (TriangleIds& ids : this->Output.Front)
  {
    for (Id& id : ids)
    {
      id = places[id];
    }
    // A numbering that does not depend on the tetrahedron.
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
  }
  std::sort(this->Output.Front.begin(), this->Output.Front.end());

  // The completed boundary carries what its sides really border on. Sides that the front has not
  // reached yet keep their label.
  const std::vector<RegionPair> given = std::move(this->Surface.Labels);
  this->Surface.Labels.resize(this->Surface.Triangles.size());
  for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
  {
    RegionPair labels = t < given.size() ? given[t] : RegionPair{};
    labels.Front = this->SideFacets[2 * t] != NoId ? this->SideRegions[2 * t] : labels.Front;
    labels.Back = this->SideFacets[2 * t + 1] != NoId ? this->SideRegions[2 * t + 1] : labels.Back;
    this->Surface.Labels[t] = labels;
  }
  for (TriangleIds& ids : this->Surface.Triangles)
  {
    for (Id& id : ids)
    {
      id = places[id];
    }
  }
  this->SortTetrahedra();
  this->Surface.Points = this->Points;
}

Status AdvancingFront::Run()
{
  Status status = this->CollectPoints();
  if (status.IsOk())
  {
    status = this->TurnDiagonals();
  }
  if (status.IsOk())
  {
    status = this->FindSeeds();
  }
  if (!status.IsOk())
  {
    return status;
  }
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    if (this->Facets.Find(this->Surface.Triangles[t]) != nullptr)
    {
      return Status::InvalidInput("Two triangles of the surface have the same points; clean the "
                                  "surface with vtkBoundaryTriangulator first.",
        { this->GetSourceCell(t) });
    }
    this->Facets.Insert(this->Surface.Triangles[t], -2 - t);
  }
  this->SideFacets.assign(2 * this->Surface.Triangles.size(), NoId);
  this->SideRegions.assign(2 * this->Surface.Triangles.size(), OutsideRegion);
  std::vector<Id> regions;
  Id nextRegion = 0;
  for (const auto& [side, label] : this->Seeds)
  {
    if (this->SideFacets[side] != NoId)
    {
      continue;
    }
    const Id region = label == NoId ? nextRegion++ : label;
    regions.push_back(region);
    status = this->GrowRegion(side, region);
    if (!status.IsOk() || this->IsStopped)
    {
      break;
    }
  }
  if (!status.IsOk() && !status.IsAborted())
  {
    return status;
  }
  SortUnique(regions);
  this->Output.Report.NumberOfRegions = static_cast<Id>(regions.size());
  this->Finish();
  return status;
}
}

Status TetrahedralizeByAdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
  const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
  AdvancingFrontTetrahedralizerOutput& output)
{
  output = AdvancingFrontTetrahedralizerOutput();
  const Status status = AdvancingFront(input, options, context, output).Run();
  if (!status.IsOk() && !status.IsAborted())
  {
    output = AdvancingFrontTetrahedralizerOutput();
  }
  return status;
}
}
