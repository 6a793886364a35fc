// SPDX-License-Identifier: BSD-3-Clause
#include "LayeredStructure.h"

#include "Core/Predicates.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace cdm
{
namespace
{
using Edge = std::pair<Id, Id>;
using Loop = std::vector<Id>;

struct Polygon
{
  Loop Outline;
  RegionPair Labels;
  /** Equal for polygons in one plane. */
  Id Plane = NoId;
};

Edge MakeEdge(Id a, Id b)
{
  return { std::min(a, b), std::max(a, b) };
}

Edge GetEdge(const Loop& loop, std::size_t i)
{
  return MakeEdge(loop[i], loop[(i + 1) % loop.size()]);
}

/** Classes of integers that can be united. */
class DisjointSets
{
public:
  explicit DisjointSets(std::size_t size) : Parents(size)
  {
    std::iota(this->Parents.begin(), this->Parents.end(), 0);
  }

  Id Find(Id i) const
  {
    while (this->Parents[i] != i)
    {
      i = this->Parents[i];
    }
    return i;
  }

  void Unite(Id i, Id j) { this->Parents[this->Find(j)] = this->Find(i); }

private:
  std::vector<Id> Parents;
};

Vec3 ToPlane(const std::array<double, 2>& vertex)
{
  return { vertex[0], vertex[1], 0.0 };
}

/** The turn at the lowest vertex in lexicographic order, a corner of the convex hull, decides. */
bool IsClockwise(const Loop& loop, const std::vector<std::array<double, 2>>& vertices)
{
  const auto lowest = std::min_element(
    loop.begin(), loop.end(), [&vertices](Id a, Id b) { return vertices[a] < vertices[b]; });
  const Id before = lowest == loop.begin() ? loop.back() : *(lowest - 1);
  const Id after = lowest + 1 == loop.end() ? loop.front() : *(lowest + 1);
  return ProjectedOrientation(
           2, ToPlane(vertices[before]), ToPlane(vertices[*lowest]), ToPlane(vertices[after])) < 0;
}

/** An edge of the layout, run such that Left and Right are the cells on its sides. */
struct LayoutEdge
{
  Id Begin;
  Id End;
  Id Left;
  Id Right = NoId;
};

std::vector<LayoutEdge> FindLayoutEdges(const std::vector<Loop>& cells)
{
  std::vector<LayoutEdge> edges;
  std::map<Edge, std::size_t> indices;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
  {
    const Loop& loop = cells[cell];
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const auto [position, isNew] = indices.emplace(GetEdge(loop, i), edges.size());
      if (isNew)
      {
        edges.push_back({ loop[i], loop[(i + 1) % loop.size()], static_cast<Id>(cell) });
      }
      else
      {
        edges[position->second].Right = static_cast<Id>(cell);
      }
    }
  }
  return edges;
}

/** Unites edges that continue each other in a straight line. */
DisjointSets FindLines(
  const std::vector<LayoutEdge>& edges, const std::vector<std::array<double, 2>>& vertices)
{
  std::vector<std::vector<Id>> edgesAtVertices(vertices.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    edgesAtVertices[edges[i].Begin].push_back(static_cast<Id>(i));
    edgesAtVertices[edges[i].End].push_back(static_cast<Id>(i));
  }
  DisjointSets lines(edges.size());
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex)
  {
    const auto& incident = edgesAtVertices[vertex];
    for (std::size_t i = 0; i < incident.size(); ++i)
    {
      for (std::size_t j = i + 1; j < incident.size(); ++j)
      {
        const LayoutEdge& a = edges[incident[i]];
        const LayoutEdge& b = edges[incident[j]];
        const Id endOfA = a.Begin + a.End - static_cast<Id>(vertex);
        const Id endOfB = b.Begin + b.End - static_cast<Id>(vertex);
        if (AreCollinear(
              ToPlane(vertices[vertex]), ToPlane(vertices[endOfA]), ToPlane(vertices[endOfB])))
        {
          lines.Unite(incident[i], incident[j]);
        }
      }
    }
  }
  return lines;
}

/** Outline as seen from the side of region front. Adds nothing inside of one region. */
void AddPolygon(std::vector<Polygon>& polygons, Loop outline, RegionPair labels, Id plane)
{
  if (labels.Front == labels.Back)
  {
    return;
  }
  if (labels.Front > labels.Back)
  {
    std::swap(labels.Front, labels.Back);
    std::reverse(outline.begin(), outline.end());
  }
  polygons.push_back({ std::move(outline), labels, plane });
}

using EdgeMap = std::map<Edge, std::vector<Id>>;

EdgeMap FindPolygonsAtEdges(const std::vector<Polygon>& polygons)
{
  EdgeMap polygonsAtEdges;
  for (std::size_t polygon = 0; polygon < polygons.size(); ++polygon)
  {
    const Loop& loop = polygons[polygon].Outline;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      polygonsAtEdges[GetEdge(loop, i)].push_back(static_cast<Id>(polygon));
    }
  }
  return polygonsAtEdges;
}

/** True if the edge of these polygons separates two pieces of one planar interface. */
bool IsInsideFacet(const std::vector<Id>& polygonsAtEdge, const std::vector<Polygon>& polygons)
{
  if (polygonsAtEdge.size() != 2)
  {
    return false;
  }
  const Polygon& p = polygons[polygonsAtEdge[0]];
  const Polygon& q = polygons[polygonsAtEdge[1]];
  return p.Plane == q.Plane && p.Labels == q.Labels;
}

/**
 * The outline of the union of two neighbours in one facet; empty if they have anything but one
 * chain of edges in common, since the union would then have a hole or touch itself.
 */
Loop JoinOutlines(Loop p, Loop q)
{
  std::set<Edge> edgesOfQ;
  for (std::size_t i = 0; i < q.size(); ++i)
  {
    edgesOfQ.insert(GetEdge(q, i));
  }
  const auto isCommon = [&p, &edgesOfQ](std::size_t i) { return edgesOfQ.count(GetEdge(p, i)); };

  // Let p begin with the chain.
  std::size_t begin = 0;
  while (begin < p.size() && (isCommon((begin + p.size() - 1) % p.size()) || !isCommon(begin)))
  {
    ++begin;
  }
  if (begin == p.size())
  {
    return {};
  }
  std::rotate(p.begin(), p.begin() + begin, p.end());
  std::size_t chain = 0;
  while (isCommon(chain))
  {
    ++chain;
  }
  const std::set<Id> verticesOfQ(q.begin(), q.end());
  const auto numberOfCommonVertices =
    std::count_if(p.begin(), p.end(), [&](Id v) { return verticesOfQ.count(v) != 0; });
  if (numberOfCommonVertices != static_cast<std::ptrdiff_t>(chain + 1))
  {
    return {};
  }

  // q runs along the chain backwards, so it goes on at p.front() where p arrives.
  std::rotate(q.begin(), std::find(q.begin(), q.end(), p.front()), q.end());
  Loop joined(p.begin() + chain, p.end());
  joined.insert(joined.end(), q.begin(), q.end() - chain);
  return joined;
}

void JoinPolygons(std::vector<Polygon>& polygons)
{
  bool isChanged = true;
  while (isChanged)
  {
    isChanged = false;
    for (const auto& [edge, incident] : FindPolygonsAtEdges(polygons))
    {
      if (!IsInsideFacet(incident, polygons))
      {
        continue;
      }
      Loop joined = JoinOutlines(polygons[incident[0]].Outline, polygons[incident[1]].Outline);
      if (!joined.empty())
      {
        polygons[incident[0]].Outline = std::move(joined);
        polygons.erase(polygons.begin() + incident[1]);
        isChanged = true;
        break;
      }
    }
  }
}

void DropVerticesInsideLines(std::vector<Polygon>& polygons, const std::vector<Vec3>& points)
{
  std::map<Id, std::set<Id>> neighbors;
  for (const Polygon& polygon : polygons)
  {
    const Loop& loop = polygon.Outline;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const Edge edge = GetEdge(loop, i);
      neighbors[edge.first].insert(edge.second);
      neighbors[edge.second].insert(edge.first);
    }
  }
  std::set<Id> dropped;
  for (const auto& [vertex, ends] : neighbors)
  {
    const Id a = *ends.begin();
    const Id b = *ends.rbegin();
    if (ends.size() == 2 && AreCollinear(points[a], points[vertex], points[b]))
    {
      neighbors[a].erase(vertex);
      neighbors[a].insert(b);
      neighbors[b].erase(vertex);
      neighbors[b].insert(a);
      dropped.insert(vertex);
    }
  }
  for (Polygon& polygon : polygons)
  {
    Loop& loop = polygon.Outline;
    loop.erase(std::remove_if(loop.begin(), loop.end(),
                 [&dropped](Id vertex) { return dropped.count(vertex) != 0; }),
      loop.end());
  }
}

/** Connected pieces of one planar interface get the same id, counted in the order of polygons. */
std::vector<Id> NumberFacets(const std::vector<Polygon>& polygons)
{
  DisjointSets facets(polygons.size());
  for (const auto& [edge, incident] : FindPolygonsAtEdges(polygons))
  {
    if (IsInsideFacet(incident, polygons))
    {
      facets.Unite(incident[0], incident[1]);
    }
  }
  std::map<Id, Id> numbers;
  std::vector<Id> facetIds;
  for (std::size_t polygon = 0; polygon < polygons.size(); ++polygon)
  {
    const Id facet = facets.Find(static_cast<Id>(polygon));
    facetIds.push_back(numbers.emplace(facet, static_cast<Id>(numbers.size())).first->second);
  }
  return facetIds;
}

/** The polygons on those points that they use, in the order of the points. */
PolygonSoup MakeSoup(const std::vector<Polygon>& polygons, const std::vector<Vec3>& points)
{
  std::vector<Id> newIds(points.size(), NoId);
  for (const Polygon& polygon : polygons)
  {
    for (const Id vertex : polygon.Outline)
    {
      newIds[vertex] = 0;
    }
  }
  PolygonSoup soup;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (newIds[i] != NoId)
    {
      newIds[i] = static_cast<Id>(soup.Points.size());
      soup.Points.push_back(points[i]);
    }
  }
  for (const Polygon& polygon : polygons)
  {
    for (const Id vertex : polygon.Outline)
    {
      soup.Connectivity.push_back(newIds[vertex]);
    }
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    soup.Labels.push_back(polygon.Labels);
  }
  return soup;
}
} // namespace

Id LayeredStructure::AddVertex(double u, double v)
{
  this->Vertices.push_back({ u, v });
  return static_cast<Id>(this->Vertices.size()) - 1;
}

Id LayeredStructure::AddCell(std::vector<Id> outline)
{
  if (IsClockwise(outline, this->Vertices))
  {
    std::reverse(outline.begin(), outline.end());
  }
  this->Cells.push_back(std::move(outline));
  return static_cast<Id>(this->Cells.size()) - 1;
}

void LayeredStructure::AddLayer(double top, std::vector<Id> regions)
{
  this->Levels.push_back(top);
  this->Regions.push_back(std::move(regions));
}

PolygonSoup LayeredStructure::MakeBoundary(std::vector<Id>& facetIds) const
{
  const Id numberOfVertices = static_cast<Id>(this->Vertices.size());
  const Id numberOfLevels = static_cast<Id>(this->Levels.size());
  const auto getRegion = [this, numberOfLevels](Id layer, Id cell)
  {
    return layer < 0 || layer + 1 >= numberOfLevels || cell == NoId ? OutsideRegion
                                                                    : this->Regions[layer][cell];
  };

  std::vector<Polygon> polygons;
  for (Id level = 0; level < numberOfLevels; ++level)
  {
    for (std::size_t cell = 0; cell < this->Cells.size(); ++cell)
    {
      Loop outline = this->Cells[cell];
      for (Id& vertex : outline)
      {
        vertex += level * numberOfVertices;
      }
      const Id cellId = static_cast<Id>(cell);
      AddPolygon(polygons, std::move(outline),
        { getRegion(level, cellId), getRegion(level - 1, cellId) }, level);
    }
  }
  const std::vector<LayoutEdge> edges = FindLayoutEdges(this->Cells);
  const DisjointSets lines = FindLines(edges, this->Vertices);
  for (Id layer = 0; layer + 1 < numberOfLevels; ++layer)
  {
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      const LayoutEdge& edge = edges[i];
      const Id below = layer * numberOfVertices;
      const Id above = below + numberOfVertices;
      AddPolygon(polygons,
        { below + edge.Begin, below + edge.End, above + edge.End, above + edge.Begin },
        { getRegion(layer, edge.Right), getRegion(layer, edge.Left) },
        numberOfLevels + lines.Find(static_cast<Id>(i)));
    }
  }

  std::vector<Vec3> points;
  for (const double level : this->Levels)
  {
    for (const auto& vertex : this->Vertices)
    {
      Vec3 point;
      point[this->Axis] = level;
      point[this->Axis == 0 ? 1 : 0] = vertex[0];
      point[this->Axis == 2 ? 1 : 2] = vertex[1];
      points.push_back(point);
    }
  }
  JoinPolygons(polygons);
  DropVerticesInsideLines(polygons, points);
  if (this->Axis == 1)
  {
    // (x, z, y) is a left-handed frame: all outlines were counter-clockwise seen in a mirror.
    for (Polygon& polygon : polygons)
    {
      std::reverse(polygon.Outline.begin(), polygon.Outline.end());
    }
  }
  facetIds = NumberFacets(polygons);
  return MakeSoup(polygons, points);
}
} // namespace cdm
