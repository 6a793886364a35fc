// SPDX-License-Identifier: BSD-3-Clause
#include "Devices/LayeredStructure.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
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
  Id Contact = NoId;
};

Edge MakeEdge(Id a, Id b)
{
  return { std::min(a, b), std::max(a, b) };
}

Edge GetEdge(const Loop& loop, std::size_t i)
{
  return MakeEdge(loop[i], loop[(i + 1) % loop.size()]);
}

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

/** Outline as seen from the side of region front. Adds nothing inside of one region. */
void AddPolygon(std::vector<Polygon>& polygons, Loop outline, RegionPair labels, Id contact = NoId)
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
  polygons.push_back({ std::move(outline), labels, contact });
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

/** True if all vertices of q lie in the plane of p. */
bool AreCoplanar(const Loop& p, const Loop& q, const std::vector<Vec3>& points)
{
  const Vec3& a = points[p[0]];
  const Vec3& b = points[p[1]];
  const auto corner = std::find_if(
    p.begin() + 2, p.end(), [&](Id vertex) { return !AreCollinear(a, b, points[vertex]); });
  return corner != p.end() &&
    std::all_of(q.begin(), q.end(),
      [&](Id vertex) { return Orientation(a, b, points[*corner], points[vertex]) == 0; });
}

/** An edge between two polygons that are pieces of one planar interface. */
struct SeamEdge
{
  Edge Points;
  Id First;
  Id Second;
  /** When it could not be taken. */
  Id Tried = 0;
};

/** In the order of the edges. */
std::vector<SeamEdge> FindSeams(
  const std::vector<Polygon>& polygons, const std::vector<Vec3>& points)
{
  std::vector<SeamEdge> seams;
  for (const auto& [edge, incident] : FindPolygonsAtEdges(polygons))
  {
    if (incident.size() == 2)
    {
      const Polygon& p = polygons[incident[0]];
      const Polygon& q = polygons[incident[1]];
      if (p.Labels == q.Labels && p.Contact == q.Contact &&
        AreCoplanar(p.Outline, q.Outline, points))
      {
        seams.push_back({ edge, incident[0], incident[1] });
      }
    }
  }
  return seams;
}

/** A simple polygon that can be joined to another one in the time that the smaller one takes. */
class JoinableOutline
{
public:
  explicit JoinableOutline(const Loop& loop) : First(loop[0])
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const std::size_t last = loop.size() - 1;
      this->Ends[loop[i]] = { loop[i == 0 ? last : i - 1], loop[i == last ? 0 : i + 1] };
    }
  }

  /**
   * Takes over the other outline, which runs along an edge of this one backwards. False, and
   * nothing changes, if they have anything but one chain of edges in common, since the union would
   * then have a hole or touch itself.
   */
  bool Join(JoinableOutline& other, const Edge& edge)
  {
    const bool isForward = this->Ends.at(edge.first).Next == edge.second;
    Id begin = isForward ? edge.first : edge.second;
    Id end = isForward ? edge.second : edge.first;
    std::size_t chain = 1;
    const std::size_t most = std::min(this->Ends.size(), other.Ends.size());
    for (; chain < most && this->Ends.at(end).Next == other.Ends.at(end).Previous; ++chain)
    {
      end = this->Ends.at(end).Next;
    }
    for (; chain < most && this->Ends.at(begin).Previous == other.Ends.at(begin).Next; ++chain)
    {
      begin = this->Ends.at(begin).Previous;
    }
    const bool isSmaller = this->Ends.size() < other.Ends.size();
    const auto& small = isSmaller ? this->Ends : other.Ends;
    const auto& large = isSmaller ? other.Ends : this->Ends;
    std::size_t common = 0;
    for (auto item = small.begin(); item != small.end() && common <= chain + 1; ++item)
    {
      common += large.count(item->first);
    }
    if (chain == most || common != chain + 1)
    {
      return false;
    }

    const Neighbors atBegin{ this->Ends.at(begin).Previous, other.Ends.at(begin).Next };
    const Neighbors atEnd{ other.Ends.at(end).Previous, this->Ends.at(end).Next };
    for (Id vertex = begin; vertex != end;)
    {
      const Id next = this->Ends.at(vertex).Next;
      this->Ends.erase(vertex);
      other.Ends.erase(vertex);
      vertex = next;
    }
    if (isSmaller)
    {
      this->Ends.swap(other.Ends);
    }
    this->Ends.insert(other.Ends.begin(), other.Ends.end());
    other.Ends.clear();
    this->Ends[begin] = atBegin;
    this->Ends[end] = atEnd;
    this->First = end;
    return true;
  }

  Loop GetLoop() const
  {
    Loop loop;
    for (Id vertex = this->First; loop.size() < this->Ends.size();
         vertex = this->Ends.at(vertex).Next)
    {
      loop.push_back(vertex);
    }
    return loop;
  }

private:
  struct Neighbors
  {
    Id Previous;
    Id Next;
  };

  std::unordered_map<Id, Neighbors> Ends;
  Id First;
};

/** Seams that could not be taken get another chance after the others. */
void JoinPolygons(std::vector<Polygon>& polygons, const std::vector<Vec3>& points)
{
  std::vector<JoinableOutline> outlines;
  for (const Polygon& polygon : polygons)
  {
    outlines.emplace_back(polygon.Outline);
  }
  DisjointSets pieces(polygons.size());
  Id time = 0;
  std::vector<Id> changed(polygons.size(), 0);
  const auto isTaken = [&](SeamEdge& seam)
  {
    const auto [p, q] = std::minmax({ pieces.Find(seam.First), pieces.Find(seam.Second) });
    if (p == q)
    {
      return true;
    }
    if (std::max(changed[p], changed[q]) < seam.Tried ||
      !outlines[p].Join(outlines[q], seam.Points))
    {
      seam.Tried = time + 1;
      return false;
    }
    pieces.Unite(p, q);
    changed[p] = ++time;
    return true;
  };
  std::vector<SeamEdge> seams = FindSeams(polygons, points);
  std::size_t numberOfSeams = 0;
  while (seams.size() != numberOfSeams)
  {
    numberOfSeams = seams.size();
    std::vector<SeamEdge> left;
    for (SeamEdge& seam : seams)
    {
      if (!isTaken(seam))
      {
        left.push_back(seam);
      }
    }
    seams = std::move(left);
  }
  std::vector<Polygon> joined;
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    if (pieces.Find(static_cast<Id>(i)) == static_cast<Id>(i))
    {
      joined.push_back({ outlines[i].GetLoop(), polygons[i].Labels, polygons[i].Contact });
    }
  }
  polygons = std::move(joined);
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
std::vector<Id> NumberFacets(const std::vector<Polygon>& polygons, const std::vector<Vec3>& points)
{
  DisjointSets facets(polygons.size());
  for (const SeamEdge& seam : FindSeams(polygons, points))
  {
    facets.Unite(seam.First, seam.Second);
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
  this->AddLayer(std::vector<double>(this->Vertices.size(), top), std::move(regions));
}

void LayeredStructure::AddLayer(std::vector<double> tops, std::vector<Id> regions)
{
  this->Tops.push_back(std::move(tops));
  this->Regions.push_back(std::move(regions));
}

void LayeredStructure::SetContacts(Id level, std::vector<Id> contacts)
{
  this->Contacts[level] = std::move(contacts);
}

PolygonSoup LayeredStructure::MakeBoundary(std::vector<Id>& facetIds) const
{
  std::vector<Id> contactIds;
  return this->MakeBoundary(facetIds, contactIds);
}

PolygonSoup LayeredStructure::MakeBoundary(
  std::vector<Id>& facetIds, std::vector<Id>& contactIds) const
{
  const Id numberOfVertices = static_cast<Id>(this->Vertices.size());
  const Id numberOfLayers = static_cast<Id>(this->Tops.size());

  // Level by level; where levels meet, the point of the lowest of them stands for all.
  std::vector<Vec3> points;
  std::vector<Id> pointIds;
  for (Id level = 0; level <= numberOfLayers; ++level)
  {
    for (Id vertex = 0; vertex < numberOfVertices; ++vertex)
    {
      const Id id = static_cast<Id>(points.size());
      const double below =
        level == 0 ? this->FirstLevel : points[id - numberOfVertices][this->Axis];
      const double height = level == 0 ? below : std::max(below, this->Tops[level - 1][vertex]);
      Vec3 point;
      point[this->Axis] = height;
      point[this->Axis == 0 ? 1 : 0] = this->Vertices[vertex][0];
      point[this->Axis == 2 ? 1 : 2] = this->Vertices[vertex][1];
      points.push_back(point);
      pointIds.push_back(level > 0 && height == below ? pointIds[id - numberOfVertices] : id);
    }
  }
  const auto getPoint = [&pointIds, numberOfVertices](Id level, Id vertex)
  { return pointIds[level * numberOfVertices + vertex]; };
  const auto isEmpty = [&](Id layer, Id cell)
  {
    const Loop& outline = this->Cells[cell];
    return std::all_of(outline.begin(), outline.end(),
      [&](Id vertex) { return getPoint(layer, vertex) == getPoint(layer + 1, vertex); });
  };
  const auto getRegion = [this](Id layer, Id cell)
  { return cell == NoId ? OutsideRegion : this->Regions[layer][cell]; };

  std::vector<Polygon> polygons;
  for (Id level = 0; level <= numberOfLayers; ++level)
  {
    const auto contacts = this->Contacts.find(level);
    for (Id cell = 0; cell < static_cast<Id>(this->Cells.size()); ++cell)
    {
      if (level > 0 && isEmpty(level - 1, cell))
      {
        continue;
      }
      Id above = level;
      while (above < numberOfLayers && isEmpty(above, cell))
      {
        ++above;
      }
      Loop outline = this->Cells[cell];
      for (Id& vertex : outline)
      {
        vertex = getPoint(level, vertex);
      }
      AddPolygon(polygons, std::move(outline),
        { above == numberOfLayers ? OutsideRegion : getRegion(above, cell),
          level == 0 ? OutsideRegion : getRegion(level - 1, cell) },
        contacts == this->Contacts.end() ? NoId : contacts->second[cell]);
    }
  }
  const std::vector<LayoutEdge> edges = FindLayoutEdges(this->Cells);
  for (Id layer = 0; layer < numberOfLayers; ++layer)
  {
    for (const LayoutEdge& edge : edges)
    {
      Loop outline{ getPoint(layer, edge.Begin), getPoint(layer, edge.End),
        getPoint(layer + 1, edge.End), getPoint(layer + 1, edge.Begin) };
      outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
      if (outline.back() == outline.front())
      {
        outline.pop_back();
      }
      if (outline.size() > 2)
      {
        AddPolygon(polygons, std::move(outline),
          { getRegion(layer, edge.Right), getRegion(layer, edge.Left) });
      }
    }
  }

  JoinPolygons(polygons, points);
  DropVerticesInsideLines(polygons, points);
  if (this->Axis == 1)
  {
    // (x, z, y) is a left-handed frame: all outlines were counter-clockwise seen in a mirror.
    for (Polygon& polygon : polygons)
    {
      std::reverse(polygon.Outline.begin(), polygon.Outline.end());
    }
  }
  facetIds = NumberFacets(polygons, points);
  contactIds.clear();
  for (const Polygon& polygon : polygons)
  {
    contactIds.push_back(polygon.Contact);
  }
  return MakeSoup(polygons, points);
}
} // namespace cdm
