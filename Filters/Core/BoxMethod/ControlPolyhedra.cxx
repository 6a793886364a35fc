// SPDX-License-Identifier: BSD-3-Clause
#include "Core/BoxMethod/ControlPolyhedra.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <tuple>

namespace cdm
{
namespace
{
constexpr const char* Activity = "Making polyhedra";

/** Tangent of the angle by which two facets may bend and still be drawn as one plane. */
constexpr double FlatTangent = 1e-9;

/** A triangle of the border at one of its edges. */
struct EdgeUse
{
  EdgeIds Edge;
  /** Index of the border facet, and its vertex that is not on the edge. */
  Id Facet;
  Id Opposite;
};

/**
 * Dual vertices are numbered in this order: border facets, border edges, circumcenters of
 * tetrahedra, points; so a circumcenter that lies on the border is named by the border.
 */
class PolyhedronMaker
{
public:
  PolyhedronMaker(const TetMesh& mesh, const ControlVolumes& volumes, int numberOfThreads,
    ControlPolyhedra& polyhedra)
    : Mesh(mesh), Volumes(volumes), Polyhedra(polyhedra)
  {
    this->LoopOptions.NumberOfThreads = numberOfThreads;
  }

  Status Run(const ExecutionContext& context);

private:
  struct Use
  {
    Id Point;
    Id Region;
    Id Polygon;
  };
  /** Polygons of dual vertices that are made one after the other, and who uses them. */
  struct Polygons
  {
    std::vector<Id> Offsets{ 0 };
    std::vector<Id> Vertices;
    /** Who uses which polygon: polygons are counted from the first one here. */
    std::vector<Use> Uses;

    Id GetSize() const { return static_cast<Id>(this->Offsets.size()) - 1; }
  };
  using RecordIterator = std::vector<SimplexIncidence::Record>::const_iterator;

  void CollectBorders();
  void FindFlatEdges();
  bool UniteVertices(const ExecutionContext& context);
  bool MakePolygons(const ExecutionContext& context);
  void AddPolygonsAround(
    const EdgeIds& edge, RecordIterator begin, RecordIterator end, Polygons& polygons) const;
  void AddBorderPolygons(Polygons& polygons) const;
  bool NumberPoints(const ExecutionContext& context);
  bool GatherBoxes(const ExecutionContext& context);
  Id AddPolygon(std::vector<Id>& vertices, Polygons& polygons) const;

  bool IsBorder(Id tetrahedron, int facet) const
  {
    return this->BorderIndices[4 * tetrahedron + facet] != NoId;
  }
  Id GetEdgeVertex(Id a, Id b) const
  {
    const EdgeIds edge = MakeEdge(a, b);
    const auto found = std::lower_bound(this->BorderEdges.begin(), this->BorderEdges.end(), edge);
    return this->FirstEdge + static_cast<Id>(found - this->BorderEdges.begin());
  }
  /** Points of a border facet, with the normal out of the region with the larger id. */
  TriangleIds GetBorderFacet(Id border) const
  {
    const Id facet = this->BorderFacets[border];
    return GetFacet(this->Mesh.Tetrahedra[facet / 4], facet % 4);
  }
  bool IsFlat(Id edgeVertex) const
  {
    return this->FlatEdges[edgeVertex - this->FirstEdge][0] != NoId;
  }
  bool AreFlat(const EdgeUse& first, const EdgeUse& second) const;
  void WalkAround(Id border, int corner, std::vector<char>& isVisited, Polygons& polygons) const;
  Vec3 GetPosition(Id vertex) const;

  const TetMesh& Mesh;
  const ControlVolumes& Volumes;
  ControlPolyhedra& Polyhedra;
  ParallelLoopOptions LoopOptions;
  /**
   * For each facet id: the index of its border facet (the same from both sides of an interface), or
   * NoId.
   */
  std::vector<Id> BorderIndices;
  /** A facet id of each border facet, in the region with the larger id. */
  std::vector<Id> BorderFacets;
  /** Ascending. */
  std::vector<EdgeIds> BorderEdges;
  /** For each border edge the two border facets that go straight on there, or NoId. */
  std::vector<EdgeIds> FlatEdges;
  Id FirstEdge = 0;
  Id FirstTetrahedron = 0;
  Id FirstPoint = 0;
  /** For each dual vertex the lowest one at the same position. */
  std::vector<Id> Names;
  /** Polygons of each block of points, then those of the border. */
  std::vector<Polygons> Blocks;
};

Status PolyhedronMaker::Run(const ExecutionContext& context)
{
  if (!context.Continue(0.0, Activity))
  {
    return Status::Aborted();
  }
  this->CollectBorders();
  const std::uint64_t borders = this->BorderFacets.size();
  const std::uint64_t tetrahedra = this->Mesh.Tetrahedra.size();
  // A border facet and its edges come in a few polygons each, a tetrahedron in one for each edge.
  const Status status =
    CheckIdRange(EdgesOfTetrahedron * tetrahedra + 15 * borders + this->Mesh.Points.size(),
      "corners of control volumes");
  if (!status.IsOk())
  {
    return status;
  }
  this->FindFlatEdges();
  return this->UniteVertices(context.Part(0.1, 0.3)) &&
      this->MakePolygons(context.Part(0.3, 0.7)) && this->NumberPoints(context.Part(0.7, 0.9)) &&
      this->GatherBoxes(context.Part(0.9, 1.0))
    ? Status()
    : Status::Aborted();
}

bool PolyhedronMaker::MakePolygons(const ExecutionContext& context)
{
  const SimplexIncidence incidence(this->Mesh, this->LoopOptions.NumberOfThreads);
  const std::size_t count = this->Mesh.Points.size();
  this->Blocks.resize(GetNumberOfBlocks(count, this->LoopOptions) + 1);
  const bool isDone = ParallelLoop(count, this->LoopOptions, context, Activity,
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      std::vector<SimplexIncidence::Record> scratch;
      for (std::size_t point = begin; point < end; ++point)
      {
        incidence.ForEachEdge(static_cast<Id>(point), scratch,
          [&](const TriangleIds& points, RecordIterator first, RecordIterator last) {
            this->AddPolygonsAround({ points[0], points[1] }, first, last, this->Blocks[block]);
          });
      }
    });
  this->AddBorderPolygons(this->Blocks.back());
  return isDone;
}

void PolyhedronMaker::CollectBorders()
{
  const Id count = static_cast<Id>(this->Mesh.Tetrahedra.size());
  this->BorderIndices.assign(4 * this->Mesh.Tetrahedra.size(), NoId);
  for (Id i = 0; i < count; ++i)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      const Id neighbor = this->Mesh.Neighbors[i][facet];
      const Id outside = neighbor == NoId ? OutsideRegion : this->Mesh.Regions[neighbor / 4];
      if (outside >= this->Mesh.Regions[i])
      {
        continue;
      }
      this->BorderIndices[4 * i + facet] = static_cast<Id>(this->BorderFacets.size());
      if (neighbor != NoId)
      {
        this->BorderIndices[neighbor] = this->BorderIndices[4 * i + facet];
      }
      this->BorderFacets.push_back(4 * i + facet);
      const TriangleIds ids = Sorted(GetFacet(this->Mesh.Tetrahedra[i], facet));
      this->BorderEdges.push_back({ ids[0], ids[1] });
      this->BorderEdges.push_back({ ids[1], ids[2] });
      this->BorderEdges.push_back({ ids[0], ids[2] });
    }
  }
  SortUnique(this->BorderEdges);
  this->FirstEdge = static_cast<Id>(this->BorderFacets.size());
  this->FirstTetrahedron = this->FirstEdge + static_cast<Id>(this->BorderEdges.size());
  this->FirstPoint = this->FirstTetrahedron + count;
}

bool PolyhedronMaker::AreFlat(const EdgeUse& first, const EdgeUse& second) const
{
  const auto getRegions = [this](Id border)
  {
    const Id facet = this->BorderFacets[border];
    const Id neighbor = this->Mesh.Neighbors[facet / 4][facet % 4];
    return EdgeIds{ this->Mesh.Regions[facet / 4],
      neighbor == NoId ? OutsideRegion : this->Mesh.Regions[neighbor / 4] };
  };
  if (getRegions(first.Facet) != getRegions(second.Facet))
  {
    return false;
  }
  const std::vector<Vec3>& points = this->Mesh.Points;
  const Vec3& origin = points[first.Edge[0]];
  const Vec3 edge = points[first.Edge[1]] - origin;
  const Vec3 a = Cross(edge, points[first.Opposite] - origin);
  const Vec3 b = Cross(edge, points[second.Opposite] - origin);
  return Norm(Cross(a, b)) < -FlatTangent * Dot(a, b);
}

void PolyhedronMaker::FindFlatEdges()
{
  std::vector<EdgeUse> uses;
  for (Id border = 0; border < this->FirstEdge; ++border)
  {
    const TriangleIds ids = this->GetBorderFacet(border);
    for (int i = 0; i < 3; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 3];
      uses.push_back({ MakeEdge(a, b), border, ids[(i + 2) % 3] });
    }
  }
  std::sort(uses.begin(), uses.end(),
    [](const EdgeUse& a, const EdgeUse& b)
    { return std::tie(a.Edge, a.Facet) < std::tie(b.Edge, b.Facet); });
  for (auto begin = uses.cbegin(), end = begin; begin != uses.cend(); begin = end)
  {
    end =
      std::find_if(begin, uses.cend(), [&](const EdgeUse& use) { return use.Edge != begin->Edge; });
    const bool isFlat = end - begin == 2 && this->AreFlat(begin[0], begin[1]);
    this->FlatEdges.push_back(
      isFlat ? EdgeIds{ begin[0].Facet, begin[1].Facet } : EdgeIds{ NoId, NoId });
  }
}

bool PolyhedronMaker::UniteVertices(const ExecutionContext& context)
{
  const std::vector<Vec3>& points = this->Mesh.Points;
  using Pairs = std::vector<std::pair<Id, Id>>;
  const auto uniteInside = [&](Id i, Pairs& pairs)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[i];
    for (int facet = 0; facet < 4; ++facet)
    {
      const Id neighbor = this->Mesh.Neighbors[i][facet];
      const TriangleIds triangle = GetFacet(ids, facet);
      if (this->IsBorder(i, facet))
      {
        if (InEquatorialSphere(points[triangle[0]], points[triangle[1]], points[triangle[2]],
              points[ids[facet]]) == 0)
        {
          pairs.emplace_back(this->FirstTetrahedron + i, this->BorderIndices[4 * i + facet]);
        }
      }
      else if (neighbor > 4 * i &&
        InSphere(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]],
          points[this->Mesh.Tetrahedra[neighbor / 4][neighbor % 4]]) == 0)
      {
        pairs.emplace_back(this->FirstTetrahedron + i, this->FirstTetrahedron + neighbor / 4);
      }
    }
  };
  const auto uniteOnBorder = [&](Id border, Pairs& pairs)
  {
    const TriangleIds ids = this->GetBorderFacet(border);
    for (int i = 0; i < 3; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 3];
      const Id c = ids[(i + 2) % 3];
      const Id edge = this->GetEdgeVertex(a, b);
      if (InDiametralSphere(points[a], points[b], points[c]) == 0)
      {
        pairs.emplace_back(border, edge);
      }
      const EdgeIds& flat = this->FlatEdges[edge - this->FirstEdge];
      if (flat[0] == border)
      {
        // Triangles with a common circumcircle.
        const TriangleIds other = this->GetBorderFacet(flat[1]);
        const Id opposite = other[0] + other[1] + other[2] - a - b;
        if (Orientation(points[a], points[b], points[c], points[opposite]) == 0 &&
          InEquatorialSphere(points[a], points[b], points[c], points[opposite]) == 0)
        {
          pairs.emplace_back(border, flat[1]);
        }
      }
    }
  };
  // Things that are equal are named by the smallest of them.
  DisjointSets sets(static_cast<std::size_t>(this->FirstPoint) + points.size());
  const auto uniteAll = [&](std::size_t count, const ExecutionContext& part, const auto& collect)
  {
    std::vector<Pairs> blocks(GetNumberOfBlocks(count, this->LoopOptions));
    const bool isDone = ParallelLoop(count, this->LoopOptions, part, Activity,
      [&](std::size_t begin, std::size_t end, std::size_t block)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          collect(static_cast<Id>(i), blocks[block]);
        }
      });
    for (const Pairs& pairs : blocks)
    {
      for (const auto& [one, other] : pairs)
      {
        sets.Unite(one, other);
      }
    }
    return isDone;
  };
  const bool isDone = uniteAll(this->Mesh.Tetrahedra.size(), context.Part(0.0, 0.8), uniteInside) &&
    uniteAll(this->BorderFacets.size(), context.Part(0.8, 1.0), uniteOnBorder);
  this->Names = sets.TakeNames();
  return isDone;
}

Vec3 PolyhedronMaker::GetPosition(Id vertex) const
{
  const std::vector<Vec3>& points = this->Mesh.Points;
  if (vertex < this->FirstEdge)
  {
    const TriangleIds ids = this->GetBorderFacet(vertex);
    return GetCircumcenter(points[ids[0]], points[ids[1]], points[ids[2]]);
  }
  if (vertex < this->FirstTetrahedron)
  {
    const EdgeIds& edge = this->BorderEdges[vertex - this->FirstEdge];
    return 0.5 * (points[edge[0]] + points[edge[1]]);
  }
  if (vertex < this->FirstPoint)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[vertex - this->FirstTetrahedron];
    return GetAccurateCircumcenter(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]]);
  }
  return points[vertex - this->FirstPoint];
}

/** The polygon of dual vertices, or NoId if fewer than three of them differ. */
Id PolyhedronMaker::AddPolygon(std::vector<Id>& vertices, Polygons& polygons) const
{
  for (Id& vertex : vertices)
  {
    vertex = this->Names[vertex];
  }
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  while (vertices.size() > 1 && vertices.front() == vertices.back())
  {
    vertices.pop_back();
  }
  if (vertices.size() < 3)
  {
    return NoId;
  }
  polygons.Vertices.insert(polygons.Vertices.end(), vertices.begin(), vertices.end());
  polygons.Offsets.push_back(static_cast<Id>(polygons.Vertices.size()));
  return polygons.GetSize() - 1;
}

void PolyhedronMaker::AddPolygonsAround(
  const EdgeIds& edge, RecordIterator begin, RecordIterator end, Polygons& polygons) const
{
  // For each tetrahedron the facets through which one enters and leaves it when going around the
  // edge counter-clockwise, seen against its direction.
  struct Step
  {
    Id Tetrahedron;
    int Entry;
    int Exit;
    bool IsVisited;
  };
  std::vector<Step> steps;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    const int index = record->Simplex % 6;
    const bool isForward =
      this->Mesh.Tetrahedra[tetrahedron][TetrahedronEdges[index][0]] == edge[0];
    // (0, 1, 2, 3), (0, 2, 3, 1), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 2, 0) and (2, 3, 0, 1) are
    // even: with the edge first, one goes from the facet opposite to the last to that of the third.
    constexpr int Rest[6][2] = { { 2, 3 }, { 3, 1 }, { 1, 2 }, { 0, 3 }, { 2, 0 }, { 0, 1 } };
    const int third = Rest[index][isForward ? 0 : 1];
    const int last = Rest[index][isForward ? 1 : 0];
    steps.push_back({ tetrahedron, last, third, false });
  }
  const auto findStep = [&](Id tetrahedron)
  {
    return std::find_if(steps.begin(), steps.end(),
      [&](const Step& step) { return step.Tetrahedron == tetrahedron; });
  };
  std::vector<Id> vertices;
  const auto walk = [&](std::vector<Step>::iterator step)
  {
    const Id region = this->Mesh.Regions[step->Tetrahedron];
    const bool isOpen = this->IsBorder(step->Tetrahedron, step->Entry);
    vertices.clear();
    if (isOpen)
    {
      vertices.push_back(this->BorderIndices[4 * step->Tetrahedron + step->Entry]);
    }
    while (!step->IsVisited)
    {
      step->IsVisited = true;
      vertices.push_back(this->FirstTetrahedron + step->Tetrahedron);
      const Id exit = 4 * step->Tetrahedron + step->Exit;
      if (this->BorderIndices[exit] != NoId)
      {
        vertices.push_back(this->BorderIndices[exit]);
        const Id middle = this->GetEdgeVertex(edge[0], edge[1]);
        if (!this->IsFlat(middle))
        {
          vertices.push_back(middle);
        }
        break;
      }
      step = findStep(this->Mesh.Neighbors[step->Tetrahedron][step->Exit] / 4);
    }
    const Id polygon = this->AddPolygon(vertices, polygons);
    if (polygon != NoId)
    {
      polygons.Uses.push_back({ edge[0], region, polygon });
      polygons.Uses.push_back({ edge[1], region, ~polygon });
    }
  };
  // Fans between two border facets first; what is left are closed rings.
  for (auto step = steps.begin(); step != steps.end(); ++step)
  {
    if (this->IsBorder(step->Tetrahedron, step->Entry))
    {
      walk(step);
    }
  }
  for (auto step = steps.begin(); step != steps.end(); ++step)
  {
    if (!step->IsVisited)
    {
      walk(step);
    }
  }
}

void PolyhedronMaker::AddBorderPolygons(Polygons& polygons) const
{
  std::vector<char> isVisited(3 * this->BorderFacets.size(), 0);
  // Fans that begin and end at edges where the border bends first; what is left goes all around.
  for (const bool isOpen : { true, false })
  {
    for (Id border = 0; border < this->FirstEdge; ++border)
    {
      const TriangleIds ids = this->GetBorderFacet(border);
      for (int corner = 0; corner < 3; ++corner)
      {
        const Id entry = this->GetEdgeVertex(ids[corner], ids[(corner + 1) % 3]);
        if (!isVisited[3 * border + corner] && this->IsFlat(entry) != isOpen)
        {
          this->WalkAround(border, corner, isVisited, polygons);
        }
      }
    }
  }
}

/** Add the part of a plane piece of the border that belongs to the point at a corner. */
void PolyhedronMaker::WalkAround(
  Id border, int corner, std::vector<char>& isVisited, Polygons& polygons) const
{
  const Id facet = this->BorderFacets[border];
  const Id neighbor = this->Mesh.Neighbors[facet / 4][facet % 4];
  const Id point = this->GetBorderFacet(border)[corner];
  const Id entry = this->GetEdgeVertex(point, this->GetBorderFacet(border)[(corner + 1) % 3]);
  std::vector<Id> vertices;
  if (!this->IsFlat(entry))
  {
    vertices = { this->FirstPoint + point, entry };
  }
  while (!isVisited[3 * border + corner])
  {
    isVisited[3 * border + corner] = 1;
    vertices.push_back(border);
    const Id exit = this->GetEdgeVertex(point, this->GetBorderFacet(border)[(corner + 2) % 3]);
    if (!this->IsFlat(exit))
    {
      vertices.push_back(exit);
      break;
    }
    const EdgeIds& flat = this->FlatEdges[exit - this->FirstEdge];
    border = flat[flat[0] == border ? 1 : 0];
    const TriangleIds next = this->GetBorderFacet(border);
    corner = static_cast<int>(std::find(next.begin(), next.end(), point) - next.begin());
  }
  const Id polygon = this->AddPolygon(vertices, polygons);
  if (polygon != NoId)
  {
    polygons.Uses.push_back({ point, this->Mesh.Regions[facet / 4], polygon });
    if (neighbor != NoId)
    {
      polygons.Uses.push_back({ point, this->Mesh.Regions[neighbor / 4], ~polygon });
    }
  }
}

/** Puts the blocks together; points are numbered where they come first. */
bool PolyhedronMaker::NumberPoints(const ExecutionContext& context)
{
  std::size_t polygons = 1;
  std::size_t corners = 0;
  for (const Polygons& block : this->Blocks)
  {
    polygons += block.Offsets.size();
    corners += block.Vertices.size();
  }
  this->Polyhedra.Offsets.reserve(polygons);
  this->Polyhedra.Connectivity.reserve(corners);
  std::vector<Id> numbers(this->Names.size(), NoId);
  std::vector<Id> vertices;
  for (Polygons& block : this->Blocks)
  {
    const Id start = static_cast<Id>(this->Polyhedra.Connectivity.size());
    std::for_each(block.Offsets.begin() + 1, block.Offsets.end(),
      [&](Id offset) { this->Polyhedra.Offsets.push_back(start + offset); });
    for (const Id vertex : block.Vertices)
    {
      if (numbers[vertex] == NoId)
      {
        numbers[vertex] = static_cast<Id>(vertices.size());
        vertices.push_back(vertex);
      }
      this->Polyhedra.Connectivity.push_back(numbers[vertex]);
    }
    block.Vertices = std::vector<Id>();
  }
  this->Polyhedra.Points.resize(vertices.size());
  return ParallelLoop(vertices.size(), this->LoopOptions, context, Activity,
    [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->Polyhedra.Points[i] = this->GetPosition(vertices[i]);
      }
    });
}

bool PolyhedronMaker::GatherBoxes(const ExecutionContext& context)
{
  std::vector<Use> uses;
  Id first = 0;
  for (const Polygons& block : this->Blocks)
  {
    for (const Use& use : block.Uses)
    {
      uses.push_back(
        { use.Point, use.Region, use.Polygon < 0 ? use.Polygon - first : use.Polygon + first });
    }
    first += block.GetSize();
  }
  // A box has a polygon once.
  const bool isDone = ParallelSort(uses, this->LoopOptions.NumberOfThreads, context, Activity,
    [](const Use& a, const Use& b)
    {
      const Id polygonOfA = a.Polygon < 0 ? ~a.Polygon : a.Polygon;
      const Id polygonOfB = b.Polygon < 0 ? ~b.Polygon : b.Polygon;
      return std::tie(a.Point, a.Region, polygonOfA) < std::tie(b.Point, b.Region, polygonOfB);
    });
  auto use = uses.cbegin();
  for (const ControlBox& box : this->Volumes.Boxes)
  {
    for (; use != uses.cend() && use->Point == box.Point && use->Region == box.Region; ++use)
    {
      this->Polyhedra.BoxPolygons.push_back(use->Polygon);
    }
    this->Polyhedra.BoxOffsets.push_back(static_cast<Id>(this->Polyhedra.BoxPolygons.size()));
  }
  return isDone;
}
} // namespace

Status MakeControlPolyhedra(const TetMesh& mesh, const ControlVolumes& volumes,
  const ExecutionContext& context, ControlPolyhedra& polyhedra)
{
  return RunGuarded(
    [&]() -> Status
    {
      polyhedra = {};
      return PolyhedronMaker(mesh, volumes, context.GetNumberOfThreads(), polyhedra).Run(context);
    });
}
} // namespace cdm
