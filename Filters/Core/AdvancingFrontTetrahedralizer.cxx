// SPDX-License-Identifier: BSD-3-Clause
#include "AdvancingFrontTetrahedralizer.h"

#include "ApexSearch.h"
#include "CosphericalCell.h"
#include "Measures.h"
#include "PointTree.h"
#include "Predicates.h"
#include "SpatialSort.h"
#include "StarTable.h"
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

/** The eight corners of a box: its faces, counter-clockwise seen from outside. */
constexpr int BoxFaces[6][4] = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
  { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };

/** What is known of the space that a side of the surface looks into before it is reached. */
constexpr Id UnknownSpace = -2;
constexpr Id OutsideSpace = -1;

/**
 * A set of small numbers that gives its smallest one: the vertices that the front has reached.
 * One bit for each number, in a tree of words.
 */
class OrderedSet
{
public:
  void Reset(std::size_t size)
  {
    this->Levels.clear();
    do
    {
      size = (size + 63) / 64;
      this->Levels.emplace_back(size, 0);
    } while (size > 1);
  }

  void Insert(Id number)
  {
    std::size_t i = static_cast<std::size_t>(number);
    for (std::vector<std::uint64_t>& level : this->Levels)
    {
      std::uint64_t& word = level[i / 64];
      const std::uint64_t before = word;
      word |= std::uint64_t(1) << (i % 64);
      if (before != 0)
      {
        return;
      }
      i /= 64;
    }
  }

  bool IsEmpty() const { return this->Levels.back()[0] == 0; }

  Id PopSmallest()
  {
    std::size_t i = 0;
    for (std::size_t level = this->Levels.size(); level-- > 0;)
    {
      i = 64 * i + CountTrailingZeros64(this->Levels[level][i]);
    }
    const Id smallest = static_cast<Id>(i);
    for (std::vector<std::uint64_t>& level : this->Levels)
    {
      std::uint64_t& word = level[i / 64];
      word &= ~(std::uint64_t(1) << (i % 64));
      if (word != 0)
      {
        break;
      }
      i /= 64;
    }
    return smallest;
  }

private:
  static std::size_t CountTrailingZeros64(std::uint64_t word)
  {
    const unsigned low = static_cast<unsigned>(word);
    return low != 0 ? CountTrailingZeros(low)
                    : 32 + CountTrailingZeros(static_cast<unsigned>(word >> 32));
  }

  std::vector<std::vector<std::uint64_t>> Levels;
};

class AdvancingFront
{
public:
  AdvancingFront(const AdvancingFrontTetrahedralizerInput& input,
    const AdvancingFrontTetrahedralizerOptions& options, const ExecutionContext& context,
    AdvancingFrontTetrahedralizerOutput& output)
    : Input(input), Options(options), Context(context), Output(output), Surface(output.Boundary),
      Points(output.Mesh.Points), Mesh(output.Mesh), Search(Tree), Cell(Points)
  {
  }

  Status Run();

private:
  /** A seed of growth: a side of the surface, its region, and the space it looks into. */
  struct SideSeed
  {
    Id Side;
    Id Region;
    Id Space;
  };
  /** A facet of the front in the list of its first vertex; (vertex, B, C) looks out. */
  struct OpenFacet
  {
    Id B;
    Id C;
    Id Facet;
    Id Next;
  };

  Status CollectPoints();
  Status TurnDiagonals();
  Status FindSeeds();
  bool LocateSeed(const Vec3& position, Id& side) const;
  Status FindFirstFacet(TriangleIds& facet);
  void PrepareFront();
  Status GrowRegion(const SideSeed& seed);
  bool IsOnHull(Id side);
  Status GrowHull();
  Status Advance(Id region);
  Status CompleteStar(Id vertex, Id region);
  Status OpenStar(Id vertex);
  Status CompleteFacet(Id b, Id c, Id region, Id sourceFacet);
  Status SplitCell(Id b, Id c, Id region);
  Status AddBox(Id region);
  Status AddTetrahedron(const TetrahedronIds& tetrahedron, Id region);
  Status AttachToStar(Id b, Id c, Id facet);
  Status AttachToSurface(Id triangle, const TriangleIds& outward, Id facet, Id region);
  void AddHullTriangle(const TriangleIds& outward, Id facet, Id region);
  bool IsFinished(Id vertex) const;
  bool IsFinishedForNow(Id vertex) const;
  Status CollectFront();
  void Finish();
  void SortHull();
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
  TriangleIds ToPoints(Id a, Id b, Id c) const
  {
    return { this->Order[a], this->Order[b], this->Order[c] };
  }
  bool HasSurface() const { return this->NumberOfSurfaceTriangles > 0; }

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

  /**
   * Vertices are points in the order of a Hilbert curve, without copies: the point of each vertex,
   * and the vertex of each point or NoId. Until the end tetrahedra are made of vertices.
   */
  std::vector<Id> Order;
  std::vector<Id> Vertices;
  PointTree Tree;
  ApexSearch Search;
  CosphericalCell Cell;
  Apex Found;

  /** For each side of the surface: the tetrahedron facet attached to it, or NoId. */
  std::vector<Id> SideFacets;
  /** Region that the front reached the side with. */
  std::vector<Id> SideRegions;
  /** What each side looks into, as far as it is known before. */
  std::vector<Id> SideSpaces;
  std::vector<SideSeed> Seeds;
  /** Surface triangles around each vertex. */
  std::vector<Id> IncidentStarts;
  std::vector<Id> Incident;

  /** Vertices with facets of the front, and the list of those of which it is the first one. */
  OrderedSet Reached;
  std::vector<Id> Lists;
  std::vector<OpenFacet> OpenFacets;
  Id FreeFacet = NoId;
  /** The vertex whose star is being completed, and the facets around it. */
  Id Vertex = NoId;
  StarTable Star;
  std::vector<StarTable::Entry> Stack;
  Id CurrentSpace = UnknownSpace;
  Id CurrentRegion = NoId;
  /** Vertices that dropped out for the present region only. */
  std::vector<Id> Postponed;
  bool IsStopped = false;
};

Status AdvancingFront::CollectPoints()
{
  const TriangleMesh none;
  const TriangleMesh& surface = this->Input.Surface != nullptr ? *this->Input.Surface : none;
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
  if (surface.Triangles.empty() && !this->Options.CloseOpenBoundary)
  {
    return Status::InvalidInput("The surface has no triangles; there is nothing to mesh. Switch "
                                "CloseOpenBoundary on to mesh the convex hull of points.");
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
  // among the mesh points. The lower number wins. Along the curve they follow each other.
  this->Order.resize(this->Points.size());
  std::iota(this->Order.begin(), this->Order.end(), 0);
  SortAlongHilbertCurve(this->Points, this->Order);
  std::vector<Id> coincident;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < this->Order.size(); ++i)
  {
    const Id point = this->Order[i];
    if (kept == 0 || this->Points[point] != this->Points[this->Order[kept - 1]])
    {
      this->Order[kept++] = point;
    }
    else if (point < this->NumberOfSurfacePoints && this->HasSurface())
    {
      coincident.push_back(this->Order[kept - 1]);
      coincident.push_back(point);
    }
  }
  this->Order.resize(kept);
  if (!coincident.empty())
  {
    SortUnique(coincident);
    return Status::InvalidInput("Points of the surface coincide; merge them with "
                                "vtkBoundaryTriangulator first.",
      {}, std::move(coincident));
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
    : Surface(surface), HasLabels(hasLabels)
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
    return last - first != 2      ? NoId
      : first->second == triangle ? (first + 1)->second
                                  : first->second;
  }

  bool HaveSameLabels(Id s, Id t, Id a, Id b) const
  {
    if (!this->HasLabels)
    {
      return true;
    }
    const auto runs = [a, b](const TriangleIds& ids)
    {
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
  if (!this->HasSurface())
  {
    return Status();
  }
  const FacetPolygons polygons(this->Surface, this->HasLabels);
  PointOctree octree;
  for (Id point : this->Order)
  {
    octree.Insert(point, this->Points[point]);
  }
  SurfaceDelaunayTest test(this->Points, octree);
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
    const int turn = ProjectedOrientation(axis, a, this->Points[first[1]], this->Points[first[2]]);
    std::sort(outline.begin(), outline.end(),
      [&](Id x, Id y)
      { return ProjectedOrientation(axis, a, this->Points[x], this->Points[y]) == turn; });
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
    const Vec3 centroid =
      (1.0 / 3.0) * (this->Points[ids[0]] + this->Points[ids[1]] + this->Points[ids[2]]);
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
  this->SideSpaces.assign(2 * this->Surface.Triangles.size(), UnknownSpace);
  if (!this->HasSurface())
  {
    return Status();
  }
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
      this->Seeds.push_back({ side, seed.Region, UnknownSpace });
    }
    return Status();
  }
  if (this->HasLabels)
  {
    for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
    {
      const Id label = this->GetSideLabel(side);
      this->SideSpaces[side] = label == OutsideRegion ? OutsideSpace : label;
      if (label != OutsideRegion)
      {
        this->Seeds.push_back({ side, label, label });
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
  std::vector<Id> spaces(sides.IsOuter.size(), UnknownSpace);
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id shell = sides.Shells[side];
    const bool isMeshed =
      !sides.IsOuter[shell] || (this->Options.CloseOpenBoundary && sides.IsOpen[shell]);
    // All sides around an opening are one shell, and some may look away from all points.
    if (isMeshed && (spaces[shell] == UnknownSpace || sides.IsOpen[shell]))
    {
      spaces[shell] = static_cast<Id>(this->Seeds.size());
      this->Seeds.push_back({ side, NoId, spaces[shell] });
    }
  }
  if (this->Seeds.empty())
  {
    return Status::InvalidInput("The surface encloses nothing: it has " +
        std::to_string(sides.OpenTriangles.size()) +
        " triangles with an open edge. Close it (MaximumGapEdges of vtkBoundaryTriangulator "
        "patches "
        "gaps), or switch CloseOpenBoundary on to mesh up to the convex hull.",
      sides.OpenTriangles);
  }
  if (!sides.OpenTriangles.empty())
  {
    // Open shells may look into the same space as others.
    for (SideSeed& seed : this->Seeds)
    {
      seed.Space = UnknownSpace;
    }
    return Status();
  }

  // The outer shell of a component that lies in the bounds of no other one looks outside.
  std::vector<Box> bounds(sides.IsOuter.size());
  std::vector<Id> outer;
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    const Id shell = sides.Shells[side];
    if (sides.IsOuter[shell])
    {
      if (bounds[shell].IsEmpty())
      {
        outer.push_back(shell);
      }
      for (Id point : this->Surface.Triangles[side / 2])
      {
        bounds[shell].Add(this->Points[point]);
      }
    }
  }
  constexpr std::size_t ManyShells = 2000;
  for (std::size_t i = 0; i < outer.size() && outer.size() < ManyShells; ++i)
  {
    const Box& inside = bounds[outer[i]];
    bool isInside = false;
    for (std::size_t j = 0; j < outer.size(); ++j)
    {
      const Box& outside = bounds[outer[j]];
      bool isWithin = i != j;
      for (int axis = 0; axis < 3; ++axis)
      {
        isWithin = isWithin && outside.Low[axis] <= inside.Low[axis] &&
          inside.High[axis] <= outside.High[axis];
      }
      isInside = isInside || isWithin;
    }
    spaces[outer[i]] = isInside ? UnknownSpace : OutsideSpace;
  }
  for (Id side = 0; side < 2 * this->NumberOfSurfaceTriangles; ++side)
  {
    this->SideSpaces[side] = spaces[sides.Shells[side]];
  }
  return Status();
}

Status AdvancingFront::AttachToSurface(Id triangle, const TriangleIds& outward, Id facet, Id region)
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
  this->Surface.Triangles.push_back(outward);
  this->Surface.SourceCells.push_back(NoId);
  if (this->HasLabels)
  {
    this->Surface.Labels.push_back({ OutsideRegion, region });
  }
  this->SideFacets.push_back(NoId);
  this->SideFacets.push_back(facet);
  this->SideRegions.push_back(OutsideRegion);
  this->SideRegions.push_back(region);
}

Status AdvancingFront::AttachToStar(Id b, Id c, Id facet)
{
  StarTable::Entry& entry = this->Star.Find(b, c);
  if (entry.Value == StarTable::Nothing)
  {
    entry = { b, c, facet };
    this->Stack.push_back(entry);
    return Status();
  }
  if (entry.Value <= StarTable::FirstBarrier)
  {
    return this->AttachToSurface(StarTable::FirstBarrier - entry.Value,
      this->ToPoints(this->Vertex, b, c), facet, this->CurrentRegion);
  }
  if (entry.Value == StarTable::Closed || entry.B == b)
  {
    return Status::InternalError("The front ran into itself: tetrahedra overlap.", {},
      { this->Order[this->Vertex], this->Order[b], this->Order[c] });
  }
  const Id other = entry.Value;
  this->Mesh.Neighbors[facet / 4][facet % 4] = other;
  this->Mesh.Neighbors[other / 4][other % 4] = facet;
  entry.Value = StarTable::Closed;
  return Status();
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
    // Facets around the present vertex meet at once, others when their first vertex is due.
    int first = 0;
    if (outward[1] == this->Vertex || outward[2] == this->Vertex)
    {
      first = outward[1] == this->Vertex ? 1 : 2;
    }
    else if (outward[0] != this->Vertex)
    {
      first = outward[0] < outward[1] ? (outward[0] < outward[2] ? 0 : 2)
                                      : (outward[1] < outward[2] ? 1 : 2);
    }
    const Id a = outward[first];
    const Id b = outward[first == 2 ? 0 : first + 1];
    const Id c = outward[first == 0 ? 2 : first - 1];
    if (a == this->Vertex)
    {
      const Status status = this->AttachToStar(b, c, facet);
      if (!status.IsOk())
      {
        return status;
      }
      continue;
    }
    Id place = this->FreeFacet;
    if (place != NoId)
    {
      this->FreeFacet = this->OpenFacets[place].Next;
      this->OpenFacets[place] = { b, c, facet, this->Lists[a] };
    }
    else
    {
      place = static_cast<Id>(this->OpenFacets.size());
      this->OpenFacets.push_back({ b, c, facet, this->Lists[a] });
    }
    if (this->Lists[a] == NoId)
    {
      this->Reached.Insert(a);
    }
    this->Lists[a] = place;
  }
  return Status();
}

Status AdvancingFront::AddBox(Id region)
{
  const Id* const corners = this->Found.Corners;
  ++this->Output.Report.CosphericalCells;
  this->Output.Report.LargestCell = std::max<Id>(this->Output.Report.LargestCell, 8);
  int lowest = 0;
  for (int corner = 1; corner < 8; ++corner)
  {
    if (this->Order[corners[corner]] < this->Order[corners[lowest]])
    {
      lowest = corner;
    }
  }
  for (const int(&face)[4] : BoxFaces)
  {
    int start = 0;
    bool hasLowest = face[0] == lowest;
    for (int i = 1; i < 4; ++i)
    {
      hasLowest = hasLowest || face[i] == lowest;
      if (this->Order[corners[face[i]]] < this->Order[corners[face[start]]])
      {
        start = i;
      }
    }
    for (int i = 1; i < 3 && !hasLowest; ++i)
    {
      const Status status =
        this->AddTetrahedron({ corners[face[start]], corners[face[(start + i + 1) % 4]],
                               corners[face[(start + i) % 4]], corners[lowest] },
          region);
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  return Status();
}

Status AdvancingFront::SplitCell(Id b, Id c, Id region)
{
  const TriangleIds base = this->ToPoints(this->Vertex, b, c);
  std::vector<Id> ids(base.begin(), base.end());
  for (Id vertex : this->Found.Cospherical)
  {
    ids.push_back(this->Order[vertex]);
  }
  for (Id vertex : this->Found.Cocircular)
  {
    ids.push_back(this->Order[vertex]);
  }
  std::sort(ids.begin(), ids.end());
  std::vector<TetrahedronIds> tetrahedra;
  if (!this->Cell.Split(base, ids, tetrahedra))
  {
    return Status::InternalError("A set of cospherical points has no convex hull.", {}, ids);
  }
  ++this->Output.Report.CosphericalCells;
  this->Output.Report.LargestCell =
    std::max(this->Output.Report.LargestCell, static_cast<Id>(ids.size()));
  for (TetrahedronIds& tetrahedron : tetrahedra)
  {
    for (Id& id : tetrahedron)
    {
      id = this->Vertices[id];
    }
    const Status status = this->AddTetrahedron(tetrahedron, region);
    if (!status.IsOk())
    {
      return status;
    }
  }
  return Status();
}

Status AdvancingFront::CompleteFacet(Id b, Id c, Id region, Id sourceFacet)
{
  this->Search.Find(b, c, this->Found);
  if (this->Found.IsUnique)
  {
    return this->AddTetrahedron({ this->Vertex, b, c, this->Found.Point }, region);
  }
  if (this->Found.Point != NoId)
  {
    return this->Found.IsBox ? this->AddBox(region) : this->SplitCell(b, c, region);
  }
  const TriangleIds base = this->ToPoints(this->Vertex, b, c);
  if (sourceFacet != NoId && this->Options.CloseOpenBoundary)
  {
    this->AddHullTriangle(base, sourceFacet, region);
    this->Star.Find(b, c).Value = StarTable::Closed;
    return Status();
  }
  return Status::InvalidInput("Region " + std::to_string(region) +
      " is not closed: the front reached the convex hull of the points. Close the surface, correct "
      "its BoundaryLabels, or switch CloseOpenBoundary on.",
    {}, { base[0], base[1], base[2] });
}

void AdvancingFront::PrepareFront()
{
  const std::size_t count = this->Order.size();
  this->Vertices.assign(this->Points.size(), NoId);
  for (std::size_t vertex = 0; vertex < count; ++vertex)
  {
    this->Vertices[this->Order[vertex]] = static_cast<Id>(vertex);
  }
  // Memory that is not used is not touched; growing would copy.
  const std::size_t expected = 7 * count;
  this->Mesh.Tetrahedra.reserve(expected);
  this->Mesh.Regions.reserve(expected);
  this->Mesh.Neighbors.reserve(expected);
  this->Tree.Build(this->Points, this->Order);
  this->Lists.assign(count, NoId);
  this->Reached.Reset(count);
  this->SideFacets.assign(2 * this->Surface.Triangles.size(), NoId);
  this->SideRegions.assign(2 * this->Surface.Triangles.size(), OutsideRegion);
  if (this->HasSurface())
  {
    this->IncidentStarts.assign(count + 1, 0);
    for (const TriangleIds& ids : this->Surface.Triangles)
    {
      for (Id point : ids)
      {
        ++this->IncidentStarts[this->Vertices[point] + 1];
      }
    }
    std::partial_sum(
      this->IncidentStarts.begin(), this->IncidentStarts.end(), this->IncidentStarts.begin());
    this->Incident.resize(this->IncidentStarts.back());
    std::vector<Id> places(this->IncidentStarts.begin(), this->IncidentStarts.end() - 1);
    for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
    {
      for (Id point : this->Surface.Triangles[t])
      {
        this->Incident[places[this->Vertices[point]]++] = t;
      }
    }
  }
}

bool AdvancingFront::IsFinished(Id vertex) const
{
  if (!this->HasSurface())
  {
    return true;
  }
  for (Id i = this->IncidentStarts[vertex]; i < this->IncidentStarts[vertex + 1]; ++i)
  {
    for (Id side = 2 * this->Incident[i]; side < 2 * this->Incident[i] + 2; ++side)
    {
      if (this->SideFacets[side] == NoId && this->SideSpaces[side] != OutsideSpace)
      {
        return false;
      }
    }
  }
  return true;
}

bool AdvancingFront::IsFinishedForNow(Id vertex) const
{
  for (Id i = this->IncidentStarts[vertex]; i < this->IncidentStarts[vertex + 1]; ++i)
  {
    for (Id side = 2 * this->Incident[i]; side < 2 * this->Incident[i] + 2; ++side)
    {
      const Id space = this->SideSpaces[side];
      if (this->SideFacets[side] == NoId &&
        (space == UnknownSpace || this->CurrentSpace == UnknownSpace ||
          space == this->CurrentSpace))
      {
        return false;
      }
    }
  }
  return true;
}

Status AdvancingFront::OpenStar(Id vertex)
{
  this->Vertex = vertex;
  this->Star.Clear();
  this->Stack.clear();
  if (this->HasSurface())
  {
    for (Id i = this->IncidentStarts[vertex]; i < this->IncidentStarts[vertex + 1]; ++i)
    {
      const TriangleIds& ids = this->Surface.Triangles[this->Incident[i]];
      const Id point = this->Order[vertex];
      const int first = ids[0] == point ? 0 : ids[1] == point ? 1 : 2;
      const Id b = this->Vertices[ids[(first + 1) % 3]];
      const Id c = this->Vertices[ids[(first + 2) % 3]];
      this->Star.Find(b, c) = { b, c, StarTable::FirstBarrier - this->Incident[i] };
    }
  }
  Id place = this->Lists[vertex];
  this->Lists[vertex] = NoId;
  while (place != NoId)
  {
    OpenFacet& open = this->OpenFacets[place];
    const Id next = open.Next;
    const Id facet = open.Facet;
    const Id b = open.B;
    const Id c = open.C;
    open.Next = this->FreeFacet;
    this->FreeFacet = place;
    place = next;
    if (facet < 0)
    {
      // The seed: a side of the surface, or the first facet of all.
      this->Stack.push_back({ b, c, facet });
      continue;
    }
    const Status status = this->AttachToStar(b, c, facet);
    if (!status.IsOk())
    {
      return status;
    }
  }
  return Status();
}

Status AdvancingFront::CompleteStar(Id vertex, Id region)
{
  Status status = this->OpenStar(vertex);
  if (!status.IsOk() || this->Stack.empty())
  {
    return status;
  }
  this->Search.SetVertex(vertex);
  while (!this->Stack.empty())
  {
    if (this->IsLimitReached())
    {
      this->IsStopped = true;
      return Status();
    }
    const StarTable::Entry facet = this->Stack.back();
    this->Stack.pop_back();
    if (facet.Value >= 0 && this->Mesh.Neighbors[facet.Value / 4][facet.Value % 4] != NoId)
    {
      continue;
    }
    status = this->CompleteFacet(facet.B, facet.C, region, facet.Value >= 0 ? facet.Value : NoId);
    if (!status.IsOk())
    {
      return status;
    }
  }
  return Status();
}

Status AdvancingFront::Advance(Id region)
{
  // About 6.7 tetrahedra per point are usual.
  const double expected = 6.7 * static_cast<double>(this->Order.size());
  std::size_t steps = 0;
  while (!this->Reached.IsEmpty())
  {
    if (++steps % (ReportInterval / 8) == 0)
    {
      const double done = static_cast<double>(this->Mesh.Tetrahedra.size()) / expected;
      if (!this->Context.Part(0.1, 0.95).Continue(std::min(done, 0.99), "Advancing the front"))
      {
        return Status::Aborted();
      }
    }
    const Id vertex = this->Reached.PopSmallest();
    const Status status = this->CompleteStar(vertex, region);
    if (!status.IsOk() || this->IsStopped)
    {
      return status;
    }
    if (this->IsFinished(vertex))
    {
      this->Tree.Remove(vertex);
    }
    else if (this->IsFinishedForNow(vertex))
    {
      this->Tree.Remove(vertex);
      this->Postponed.push_back(vertex);
    }
  }
  return Status();
}

bool AdvancingFront::IsOnHull(Id side)
{
  const TriangleIds ids = this->GetSideTriangle(side);
  this->Search.SetVertex(this->Vertices[ids[0]]);
  this->Search.Find(this->Vertices[ids[1]], this->Vertices[ids[2]], this->Found);
  return this->Found.Point == NoId;
}

Status AdvancingFront::GrowRegion(const SideSeed& seed)
{
  this->CurrentSpace = seed.Space;
  this->CurrentRegion = seed.Region;
  const TriangleIds ids = this->GetSideTriangle(seed.Side);
  const TriangleIds base{ this->Vertices[ids[0]], this->Vertices[ids[1]], this->Vertices[ids[2]] };
  const int first = static_cast<int>(std::min_element(base.begin(), base.end()) - base.begin());
  this->Lists[base[first]] = static_cast<Id>(this->OpenFacets.size());
  this->OpenFacets.push_back({ base[(first + 1) % 3], base[(first + 2) % 3], NoId, NoId });
  this->Reached.Insert(base[first]);
  const std::size_t before = this->Mesh.Tetrahedra.size();
  Status status = this->Advance(seed.Region);
  if (!status.IsOk())
  {
    if (status.Cells.empty() && status.Code == StatusCode::InvalidInput &&
      this->Mesh.Tetrahedra.size() == before)
    {
      status.Cells.push_back(this->GetSourceCell(seed.Side / 2));
    }
    return status;
  }
  if (this->IsStopped)
  {
    return Status();
  }
  if (this->SideFacets[seed.Side] == NoId)
  {
    return Status::InternalError(
      "A boundary triangle is no facet of the mesh.", { this->GetSourceCell(seed.Side / 2) });
  }
  for (Id vertex : this->Postponed)
  {
    if (!this->IsFinished(vertex))
    {
      this->Tree.Restore(vertex);
    }
  }
  this->Postponed.clear();
  this->Search.ForgetNearPoints();
  return Status();
}

Status AdvancingFront::FindFirstFacet(TriangleIds& facet)
{
  const char* const tooFew = "A mesh needs four points that do not coincide.";
  const char* const collinear = "All points lie on one line: they have no tetrahedra.";
  const char* const coplanar = "All points lie in one plane: they have no tetrahedra.";
  const Id count = static_cast<Id>(this->Order.size());
  if (count < 4)
  {
    return Status::InvalidInput(tooFew);
  }
  // Two points whose smallest sphere is empty: start near the first point, and take what disturbs.
  const Vec3 a = this->Tree.GetPoint(0);
  Id second = 1;
  for (Id i = 1; i < count; ++i)
  {
    if (Distance(a, this->Tree.GetPoint(i)) < Distance(a, this->Tree.GetPoint(second)))
    {
      second = i;
    }
  }
  for (Id i = 1; i < count; ++i)
  {
    if (i != second &&
      InDiametralSphere(a, this->Tree.GetPoint(second), this->Tree.GetPoint(i)) > 0)
    {
      second = i;
      i = 0;
    }
  }
  // The third point likewise: what disturbs makes the sphere smaller.
  const Vec3 b = this->Tree.GetPoint(second);
  Id third = NoId;
  double smallest = std::numeric_limits<double>::infinity();
  for (Id i = 1; i < count; ++i)
  {
    const Vec3 p = this->Tree.GetPoint(i);
    if (i == second)
    {
      continue;
    }
    const double radius = Norm(GetCircumcenterOffset(a, b, p));
    if ((third == NoId || radius < smallest) && !AreCollinear(a, b, p))
    {
      third = i;
      smallest = radius;
    }
  }
  if (third == NoId)
  {
    return Status::InvalidInput(collinear);
  }
  for (Id i = 1; i < count; ++i)
  {
    if (i != second && i != third &&
      InEquatorialSphere(a, b, this->Tree.GetPoint(third), this->Tree.GetPoint(i)) > 0)
    {
      third = i;
      i = 0;
    }
  }
  // Points on its sphere make a cell of their own: then take the triangle of its hull at the edge,
  // which is one of the subdivision since the edge's smallest sphere is empty.
  std::vector<Id> cell{ third };
  bool isFlat = true;
  bool isFlatSet = true;
  Vec3 c = this->Tree.GetPoint(third);
  for (Id i = 1; i < count; ++i)
  {
    if (i == second || i == third)
    {
      continue;
    }
    const Vec3 p = this->Tree.GetPoint(i);
    const bool isCoplanar = (isFlat || isFlatSet) && Orientation(a, b, c, p) == 0;
    isFlatSet = isFlatSet && isCoplanar;
    if (InEquatorialSphere(a, b, c, p) == 0)
    {
      isFlat = isFlat && isCoplanar;
      cell.push_back(i);
    }
  }
  if (isFlatSet)
  {
    return Status::InvalidInput(coplanar);
  }
  for (Id i : cell)
  {
    if (i != third && Orientation(a, b, this->Tree.GetPoint(third), this->Tree.GetPoint(i)) < 0)
    {
      third = i;
    }
  }
  facet = { 0, second, third };
  return Status();
}

Status AdvancingFront::GrowHull()
{
  TriangleIds facet;
  Status status = this->FindFirstFacet(facet);
  if (!status.IsOk())
  {
    return status;
  }
  this->CurrentRegion = 0;
  this->Vertex = facet[0];
  this->Search.SetVertex(facet[0]);
  this->Search.Find(facet[1], facet[2], this->Found);
  if (this->Found.Point == NoId)
  {
    std::swap(facet[1], facet[2]);
  }
  this->Lists[facet[0]] = 0;
  this->OpenFacets.push_back({ facet[1], facet[2], NoId, NoId });
  this->Reached.Insert(facet[0]);
  return this->Advance(0);
}

void AdvancingFront::SortTetrahedra()
{
  // A numbering that depends on the tetrahedra alone: each starts with its first vertex along the
  // curve, then the first of the others as far as the orientation allows; all in the order of their
  // vertices. The twelve even permutations, by the place of the first and the second vertex:
  static constexpr signed char Turns[12][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 },
    { 1, 0, 3, 2 }, { 1, 3, 2, 0 }, { 1, 2, 0, 3 }, { 2, 0, 1, 3 }, { 2, 1, 3, 0 }, { 2, 3, 0, 1 },
    { 3, 0, 2, 1 }, { 3, 2, 1, 0 }, { 3, 1, 0, 2 } };
  TetMesh& mesh = this->Mesh;
  const Id count = static_cast<Id>(mesh.Tetrahedra.size());
  std::vector<unsigned char> turns(count);
  std::vector<Id> starts(this->Order.size() + 1, 0);
  for (Id t = 0; t < count; ++t)
  {
    TetrahedronIds& ids = mesh.Tetrahedra[t];
    const int first = static_cast<int>(std::min_element(ids.begin(), ids.end()) - ids.begin());
    int turn = 3 * first;
    for (int other = 3 * first + 1; other < 3 * first + 3; ++other)
    {
      turn = ids[Turns[other][1]] < ids[Turns[turn][1]] ? other : turn;
    }
    const TetrahedronIds old = ids;
    for (int i = 0; i < 4; ++i)
    {
      ids[i] = old[Turns[turn][i]];
    }
    turns[t] = static_cast<unsigned char>(turn);
    ++starts[ids[0] + 1];
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Id> places(count);
  {
    std::vector<Id> order(count);
    std::vector<Id> next(starts.begin(), starts.end() - 1);
    for (Id t = 0; t < count; ++t)
    {
      order[next[mesh.Tetrahedra[t][0]]++] = t;
    }
    for (std::size_t vertex = 0; vertex + 1 < starts.size(); ++vertex)
    {
      std::sort(order.begin() + starts[vertex], order.begin() + starts[vertex + 1],
        [&mesh](Id i, Id j) { return mesh.Tetrahedra[i] < mesh.Tetrahedra[j]; });
    }
    for (Id i = 0; i < count; ++i)
    {
      places[order[i]] = i;
    }
  }
  unsigned char inverse[12][4];
  for (int turn = 0; turn < 12; ++turn)
  {
    for (int i = 0; i < 4; ++i)
    {
      inverse[turn][static_cast<int>(Turns[turn][i])] = static_cast<unsigned char>(i);
    }
  }
  for (Id t = 0; t < count; ++t)
  {
    const TetrahedronIds old = mesh.Neighbors[t];
    for (int i = 0; i < 4; ++i)
    {
      const Id facet = old[Turns[turns[t]][i]];
      mesh.Neighbors[t][i] =
        facet == NoId ? NoId : 4 * places[facet / 4] + inverse[turns[facet / 4]][facet % 4];
    }
  }
  // In place: a copy would be the largest array of all.
  for (Id t = 0; t < count; ++t)
  {
    while (places[t] != t)
    {
      const Id place = places[t];
      std::swap(mesh.Tetrahedra[t], mesh.Tetrahedra[place]);
      std::swap(mesh.Neighbors[t], mesh.Neighbors[place]);
      std::swap(mesh.Regions[t], mesh.Regions[place]);
      std::swap(places[t], places[place]);
    }
  }
}

Status AdvancingFront::CollectFront()
{
  // Facets wait in the lists until their first vertex is due: let them meet now.
  for (Id vertex = 0; vertex < static_cast<Id>(this->Lists.size()); ++vertex)
  {
    if (this->Lists[vertex] != NoId)
    {
      const Status status = this->OpenStar(vertex);
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  std::vector<Id> closed;
  for (Id facet : this->SideFacets)
  {
    if (facet != NoId)
    {
      closed.push_back(facet);
    }
  }
  std::sort(closed.begin(), closed.end());
  for (std::size_t t = 0; t < this->Mesh.Tetrahedra.size(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (this->Mesh.Neighbors[t][i] == NoId &&
        !std::binary_search(closed.begin(), closed.end(), static_cast<Id>(4 * t + i)))
      {
        const TriangleIds outward = GetFacet(this->Mesh.Tetrahedra[t], i);
        this->Output.Front.push_back(this->ToPoints(outward[0], outward[1], outward[2]));
      }
    }
  }
  return Status();
}

void AdvancingFront::Finish()
{
  this->SortTetrahedra();

  // Only mesh points that are used stay.
  std::vector<Id> places(this->Points.size(), NoId);
  {
    std::vector<char> isUsed(this->Order.size(), 0);
    for (const TetrahedronIds& ids : this->Mesh.Tetrahedra)
    {
      for (Id vertex : ids)
      {
        isUsed[vertex] = 1;
      }
    }
    for (std::size_t vertex = 0; vertex < isUsed.size(); ++vertex)
    {
      places[this->Order[vertex]] = isUsed[vertex] ? 0 : NoId;
    }
  }
  Id count = this->NumberOfSurfacePoints;
  for (Id i = 0; i < static_cast<Id>(places.size()); ++i)
  {
    if (i < this->NumberOfSurfacePoints)
    {
      this->Output.Report.UnusedMeshPoints += !this->HasSurface() && places[i] == NoId ? 1 : 0;
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
  for (Id& point : this->Order)
  {
    point = places[point];
  }
  for (TetrahedronIds& ids : this->Mesh.Tetrahedra)
  {
    for (Id& id : ids)
    {
      id = this->Order[id];
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
  this->SortHull();
  this->Surface.Points = this->Points;
}

void AdvancingFront::SortHull()
{
  // Triangles that close the boundary were found in the order of the growth.
  const std::size_t begin = static_cast<std::size_t>(this->NumberOfSurfaceTriangles);
  std::vector<std::pair<TriangleIds, RegionPair>> hull;
  for (std::size_t t = begin; t < this->Surface.Triangles.size(); ++t)
  {
    TriangleIds ids = this->Surface.Triangles[t];
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    hull.emplace_back(ids, this->Surface.Labels[t]);
  }
  std::sort(
    hull.begin(), hull.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  for (std::size_t i = 0; i < hull.size(); ++i)
  {
    this->Surface.Triangles[begin + i] = hull[i].first;
    this->Surface.Labels[begin + i] = hull[i].second;
  }
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
  std::vector<std::pair<TriangleIds, Id>> sorted;
  for (Id t = 0; t < this->NumberOfSurfaceTriangles; ++t)
  {
    TriangleIds ids = this->Surface.Triangles[t];
    std::sort(ids.begin(), ids.end());
    sorted.emplace_back(ids, t);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
  {
    if (sorted[i].first == sorted[i - 1].first)
    {
      return Status::InvalidInput("Two triangles of the surface have the same points; clean the "
                                  "surface with vtkBoundaryTriangulator first.",
        { this->GetSourceCell(sorted[i].second) });
    }
  }
  this->PrepareFront();
  std::vector<Id> regions;
  Id nextRegion = 0;
  if (!this->HasSurface())
  {
    regions.push_back(0);
    status = this->GrowHull();
  }
  for (SideSeed seed : this->Seeds)
  {
    if (this->SideFacets[seed.Side] != NoId ||
      (this->Options.CloseOpenBoundary && this->IsOnHull(seed.Side)))
    {
      continue;
    }
    seed.Region = seed.Region == NoId ? nextRegion++ : seed.Region;
    regions.push_back(seed.Region);
    status = this->GrowRegion(seed);
    if (!status.IsOk() || this->IsStopped)
    {
      break;
    }
  }
  if (status.IsAborted() || this->IsStopped)
  {
    const Status collected = this->CollectFront();
    status = collected.IsOk() ? status : collected;
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
} // namespace

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
} // namespace cdm
