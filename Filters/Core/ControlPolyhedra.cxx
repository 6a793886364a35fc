// SPDX-License-Identifier: BSD-3-Clause
#include "ControlPolyhedra.h"

#include "IdLimits.h"
#include "Measures.h"
#include "Predicates.h"
#include "SimplexIncidence.h"
#include "VoronoiMeasures.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace cdm
{
namespace
{
constexpr Id ContinueInterval = 1 << 10;
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

/** Sets of equal things, each named by its smallest member. */
class EqualSets
{
public:
  explicit EqualSets(Id size) : Parents(size)
  {
    std::iota(this->Parents.begin(), this->Parents.end(), 0);
  }
  Id Find(Id item)
  {
    while (this->Parents[item] != item)
    {
      this->Parents[item] = this->Parents[this->Parents[item]];
      item = this->Parents[item];
    }
    return item;
  }
  void Unite(Id a, Id b)
  {
    a = this->Find(a);
    b = this->Find(b);
    this->Parents[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<Id> Parents;
};

/**
 * Dual vertices are numbered in this order: border facets, border edges, circumcenters of
 * tetrahedra, points; so a circumcenter that lies on the border is named by the border.
 */
class PolyhedronMaker
{
public:
  PolyhedronMaker(const TetMesh& mesh, const ControlVolumes& volumes, ControlPolyhedra& polyhedra)
    : Mesh(mesh), Volumes(volumes), Polyhedra(polyhedra), Sets(0)
  {
  }

  Status Run(const ExecutionContext& context);

private:
  struct Use
  {
    Id Point;
    Id Region;
    Id Polygon;
  };
  using RecordIterator = std::vector<SimplexIncidence::Record>::const_iterator;

  void CollectBorders();
  void FindFlatEdges();
  bool UniteVertices(const ExecutionContext& context);
  void AddPolygonsAround(const EdgeIds& edge, RecordIterator begin, RecordIterator end);
  void AddBorderPolygons();
  void GatherBoxes();
  Id AddPolygon();

  bool IsBorder(Id tetrahedron, int facet) const
  {
    return this->BorderIndices[4 * tetrahedron + facet] != NoId;
  }
  Id GetEdgeVertex(Id a, Id b) const
  {
    const EdgeIds edge{ std::min(a, b), std::max(a, b) };
    const auto found = std::lower_bound(this->BorderEdges.begin(), this->BorderEdges.end(), edge);
    return this->FirstEdge + static_cast<Id>(found - this->BorderEdges.begin());
  }
  /** Points of a border facet, its normal turned out of the region with the larger id. */
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
  void WalkAround(Id border, int corner, std::vector<char>& isVisited);
  Vec3 GetPosition(Id vertex) const;

  const TetMesh& Mesh;
  const ControlVolumes& Volumes;
  ControlPolyhedra& Polyhedra;
  /** By facet id: index of a border facet, the same from both sides of an interface, or NoId. */
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
  EqualSets Sets;
  /** Output point of each dual vertex, or NoId. */
  std::vector<Id> OutputPoints;
  /** Dual vertices of the polygon in the making. */
  std::vector<Id> Polygon;
  std::vector<Use> Uses;
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
  if (!this->UniteVertices(context.Part(0.1, 0.3)))
  {
    return Status::Aborted();
  }
  const SimplexIncidence incidence(this->Mesh, 1);
  std::vector<SimplexIncidence::Record> scratch;
  const Id count = static_cast<Id>(this->Mesh.Points.size());
  for (Id point = 0; point < count; ++point)
  {
    if (point % ContinueInterval == 0 && !context.Continue(0.3 + 0.6 * point / count, Activity))
    {
      return Status::Aborted();
    }
    incidence.ForEachEdge(point, scratch,
      [&](const TriangleIds& points, RecordIterator begin, RecordIterator end) {
        this->AddPolygonsAround({ points[0], points[1] }, begin, end);
      });
  }
  this->AddBorderPolygons();
  this->GatherBoxes();
  return context.Continue(1.0, Activity) ? Status() : Status::Aborted();
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
      TriangleIds ids = GetFacet(this->Mesh.Tetrahedra[i], facet);
      std::sort(ids.begin(), ids.end());
      this->BorderEdges.push_back({ ids[0], ids[1] });
      this->BorderEdges.push_back({ ids[1], ids[2] });
      this->BorderEdges.push_back({ ids[0], ids[2] });
    }
  }
  std::sort(this->BorderEdges.begin(), this->BorderEdges.end());
  this->BorderEdges.erase(
    std::unique(this->BorderEdges.begin(), this->BorderEdges.end()), this->BorderEdges.end());
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
      uses.push_back({ { std::min(a, b), std::max(a, b) }, border, ids[(i + 2) % 3] });
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
  const Id size = this->FirstPoint + static_cast<Id>(this->Mesh.Points.size());
  this->Sets = EqualSets(size);
  this->OutputPoints.assign(size, NoId);
  const std::vector<Vec3>& points = this->Mesh.Points;
  const Id count = static_cast<Id>(this->Mesh.Tetrahedra.size());
  for (Id i = 0; i < count; ++i)
  {
    if (i % ContinueInterval == 0 && !context.Continue(static_cast<double>(i) / count, Activity))
    {
      return false;
    }
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
          this->Sets.Unite(this->FirstTetrahedron + i, this->BorderIndices[4 * i + facet]);
        }
      }
      else if (neighbor > 4 * i &&
        InSphere(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]],
          points[this->Mesh.Tetrahedra[neighbor / 4][neighbor % 4]]) == 0)
      {
        this->Sets.Unite(this->FirstTetrahedron + i, this->FirstTetrahedron + neighbor / 4);
      }
    }
  }
  for (Id border = 0; border < this->FirstEdge; ++border)
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
        this->Sets.Unite(border, edge);
      }
      const EdgeIds& flat = this->FlatEdges[edge - this->FirstEdge];
      if (flat[0] == border)
      {
        // Triangles of one circle.
        const TriangleIds other = this->GetBorderFacet(flat[1]);
        const Id opposite = other[0] + other[1] + other[2] - a - b;
        if (Orientation(points[a], points[b], points[c], points[opposite]) == 0 &&
          InEquatorialSphere(points[a], points[b], points[c], points[opposite]) == 0)
        {
          this->Sets.Unite(border, flat[1]);
        }
      }
    }
  }
  return true;
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

/** The polygon of the collected dual vertices, or NoId if fewer than three of them differ. */
Id PolyhedronMaker::AddPolygon()
{
  for (Id& vertex : this->Polygon)
  {
    vertex = this->Sets.Find(vertex);
  }
  this->Polygon.erase(std::unique(this->Polygon.begin(), this->Polygon.end()), this->Polygon.end());
  while (this->Polygon.size() > 1 && this->Polygon.front() == this->Polygon.back())
  {
    this->Polygon.pop_back();
  }
  if (this->Polygon.size() < 3)
  {
    return NoId;
  }
  for (const Id vertex : this->Polygon)
  {
    Id& output = this->OutputPoints[vertex];
    if (output == NoId)
    {
      output = static_cast<Id>(this->Polyhedra.Points.size());
      this->Polyhedra.Points.push_back(this->GetPosition(vertex));
    }
    this->Polyhedra.Connectivity.push_back(output);
  }
  this->Polyhedra.Offsets.push_back(static_cast<Id>(this->Polyhedra.Connectivity.size()));
  return static_cast<Id>(this->Polyhedra.Offsets.size()) - 2;
}

void PolyhedronMaker::AddPolygonsAround(
  const EdgeIds& edge, RecordIterator begin, RecordIterator end)
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
  const auto walk = [&](std::vector<Step>::iterator step)
  {
    const Id region = this->Mesh.Regions[step->Tetrahedron];
    const bool isOpen = this->IsBorder(step->Tetrahedron, step->Entry);
    this->Polygon.clear();
    if (isOpen)
    {
      this->Polygon.push_back(this->BorderIndices[4 * step->Tetrahedron + step->Entry]);
    }
    while (!step->IsVisited)
    {
      step->IsVisited = true;
      this->Polygon.push_back(this->FirstTetrahedron + step->Tetrahedron);
      const Id exit = 4 * step->Tetrahedron + step->Exit;
      if (this->BorderIndices[exit] != NoId)
      {
        this->Polygon.push_back(this->BorderIndices[exit]);
        const Id middle = this->GetEdgeVertex(edge[0], edge[1]);
        if (!this->IsFlat(middle))
        {
          this->Polygon.push_back(middle);
        }
        break;
      }
      step = findStep(this->Mesh.Neighbors[step->Tetrahedron][step->Exit] / 4);
    }
    const Id polygon = this->AddPolygon();
    if (polygon != NoId)
    {
      this->Uses.push_back({ edge[0], region, polygon });
      this->Uses.push_back({ edge[1], region, ~polygon });
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

void PolyhedronMaker::AddBorderPolygons()
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
          this->WalkAround(border, corner, isVisited);
        }
      }
    }
  }
}

/** Add the part of a plane piece of the border that belongs to the point at a corner. */
void PolyhedronMaker::WalkAround(Id border, int corner, std::vector<char>& isVisited)
{
  const Id facet = this->BorderFacets[border];
  const Id neighbor = this->Mesh.Neighbors[facet / 4][facet % 4];
  const Id point = this->GetBorderFacet(border)[corner];
  const Id entry = this->GetEdgeVertex(point, this->GetBorderFacet(border)[(corner + 1) % 3]);
  this->Polygon.clear();
  if (!this->IsFlat(entry))
  {
    this->Polygon = { this->FirstPoint + point, entry };
  }
  while (!isVisited[3 * border + corner])
  {
    isVisited[3 * border + corner] = 1;
    this->Polygon.push_back(border);
    const Id exit = this->GetEdgeVertex(point, this->GetBorderFacet(border)[(corner + 2) % 3]);
    if (!this->IsFlat(exit))
    {
      this->Polygon.push_back(exit);
      break;
    }
    const EdgeIds& flat = this->FlatEdges[exit - this->FirstEdge];
    border = flat[flat[0] == border ? 1 : 0];
    const TriangleIds next = this->GetBorderFacet(border);
    corner = static_cast<int>(std::find(next.begin(), next.end(), point) - next.begin());
  }
  const Id polygon = this->AddPolygon();
  if (polygon != NoId)
  {
    this->Uses.push_back({ point, this->Mesh.Regions[facet / 4], polygon });
    if (neighbor != NoId)
    {
      this->Uses.push_back({ point, this->Mesh.Regions[neighbor / 4], ~polygon });
    }
  }
}

void PolyhedronMaker::GatherBoxes()
{
  std::stable_sort(this->Uses.begin(), this->Uses.end(),
    [](const Use& a, const Use& b)
    { return std::tie(a.Point, a.Region) < std::tie(b.Point, b.Region); });
  auto use = this->Uses.cbegin();
  for (const ControlBox& box : this->Volumes.Boxes)
  {
    for (; use != this->Uses.cend() && use->Point == box.Point && use->Region == box.Region; ++use)
    {
      this->Polyhedra.BoxPolygons.push_back(use->Polygon);
    }
    this->Polyhedra.BoxOffsets.push_back(static_cast<Id>(this->Polyhedra.BoxPolygons.size()));
  }
}
} // namespace

Status MakeControlPolyhedra(const TetMesh& mesh, const ControlVolumes& volumes,
  const ExecutionContext& context, ControlPolyhedra& polyhedra)
{
  polyhedra = {};
  return PolyhedronMaker(mesh, volumes, polyhedra).Run(context);
}
} // namespace cdm
