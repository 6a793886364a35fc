// SPDX-License-Identifier: BSD-3-Clause
#include "ControlPolyhedra.h"

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

  bool Run(const ExecutionContext& context);

private:
  struct Use
  {
    Id Point;
    Id Region;
    Id Polygon;
  };
  using RecordIterator = std::vector<SimplexIncidence::Record>::const_iterator;

  void CollectBorders();
  void UniteVertices();
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
  Vec3 GetPosition(Id vertex) const;

  const TetMesh& Mesh;
  const ControlVolumes& Volumes;
  ControlPolyhedra& Polyhedra;
  /** By facet id: index of a border facet, the same from both sides of an interface, or NoId. */
  std::vector<Id> BorderIndices;
  /** A facet id of each border facet. */
  std::vector<Id> BorderFacets;
  /** Ascending. */
  std::vector<EdgeIds> BorderEdges;
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

bool PolyhedronMaker::Run(const ExecutionContext& context)
{
  if (!context.Continue(0.0, "Making polyhedra"))
  {
    return false;
  }
  this->CollectBorders();
  this->UniteVertices();
  const SimplexIncidence incidence = SimplexIncidence::OfEdges(this->Mesh);
  std::vector<SimplexIncidence::Record> scratch;
  const Id count = static_cast<Id>(this->Mesh.Points.size());
  for (Id point = 0; point < count; ++point)
  {
    if (point % ContinueInterval == 0 &&
      !context.Continue(0.2 + 0.6 * point / count, "Making polyhedra"))
    {
      return false;
    }
    incidence.ForEachGroup(point, scratch,
      [&](const TriangleIds& points, RecordIterator begin, RecordIterator end) {
        this->AddPolygonsAround({ points[0], points[1] }, begin, end);
      });
  }
  this->AddBorderPolygons();
  this->GatherBoxes();
  return context.Continue(1.0, "Making polyhedra");
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
      const bool isOuter = neighbor == NoId;
      if (!isOuter && this->Mesh.Regions[neighbor / 4] == this->Mesh.Regions[i])
      {
        continue;
      }
      if (!isOuter && this->BorderIndices[neighbor] != NoId)
      {
        this->BorderIndices[4 * i + facet] = this->BorderIndices[neighbor];
        continue;
      }
      this->BorderIndices[4 * i + facet] = static_cast<Id>(this->BorderFacets.size());
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

void PolyhedronMaker::UniteVertices()
{
  const Id size = this->FirstPoint + static_cast<Id>(this->Mesh.Points.size());
  this->Sets = EqualSets(size);
  this->OutputPoints.assign(size, NoId);
  const std::vector<Vec3>& points = this->Mesh.Points;
  for (Id i = 0; i < static_cast<Id>(this->Mesh.Tetrahedra.size()); ++i)
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
    const Id facet = this->BorderFacets[border];
    const TriangleIds ids = GetFacet(this->Mesh.Tetrahedra[facet / 4], facet % 4);
    for (int i = 0; i < 3; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 3];
      if (InDiametralSphere(points[a], points[b], points[ids[(i + 2) % 3]]) == 0)
      {
        this->Sets.Unite(border, this->GetEdgeVertex(a, b));
      }
    }
  }
}

Vec3 PolyhedronMaker::GetPosition(Id vertex) const
{
  const std::vector<Vec3>& points = this->Mesh.Points;
  if (vertex < this->FirstEdge)
  {
    const Id facet = this->BorderFacets[vertex];
    const TriangleIds ids = GetFacet(this->Mesh.Tetrahedra[facet / 4], facet % 4);
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
        this->Polygon.push_back(this->GetEdgeVertex(edge[0], edge[1]));
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
  for (Id border = 0; border < this->FirstEdge; ++border)
  {
    const Id facet = this->BorderFacets[border];
    const Id neighbor = this->Mesh.Neighbors[facet / 4][facet % 4];
    const TriangleIds ids = GetFacet(this->Mesh.Tetrahedra[facet / 4], facet % 4);
    for (int i = 0; i < 3; ++i)
    {
      const Id point = ids[i];
      this->Polygon = { this->FirstPoint + point, this->GetEdgeVertex(point, ids[(i + 1) % 3]),
        border, this->GetEdgeVertex(point, ids[(i + 2) % 3]) };
      const Id polygon = this->AddPolygon();
      if (polygon == NoId)
      {
        continue;
      }
      this->Uses.push_back({ point, this->Mesh.Regions[facet / 4], polygon });
      if (neighbor != NoId)
      {
        this->Uses.push_back({ point, this->Mesh.Regions[neighbor / 4], ~polygon });
      }
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
  return PolyhedronMaker(mesh, volumes, polyhedra).Run(context) ? Status() : Status::Aborted();
}
} // namespace cdm
