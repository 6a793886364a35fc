// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/TJunctions.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/BoxTree.h"

#include <algorithm>

namespace cdm
{
namespace
{
struct VertexOnEdge
{
  Id Edge;
  Id Vertex;
};

bool IsEdgeLess(const VertexOnEdge& a, const VertexOnEdge& b)
{
  return a.Edge < b.Edge;
}

/**
 * Whether a point lies on an edge. The point has to lie in the box of the edge and must not be one
 * of its ends.
 */
bool IsOnEdge(const std::vector<Vec3>& points, const EdgeIds& edge, const Vec3& p, double tolerance)
{
  const Vec3& a = points[edge[0]];
  const Vec3& b = points[edge[1]];
  if (tolerance == 0.0)
  {
    return AreCollinear(a, b, p);
  }
  const Vec3 direction = b - a;
  const double ratio = Dot(p - a, direction) / SquaredNorm(direction);
  return ratio > 0.0 && ratio < 1.0 && Distance(p, a + ratio * direction) < tolerance;
}

/** Exactly on an edge, the order along it is the lexicographic one. */
void SortAlongEdges(const std::vector<Vec3>& points, const std::vector<EdgeIds>& edges,
  bool isExact, std::vector<VertexOnEdge>& found)
{
  std::sort(found.begin(), found.end(),
    [&](const VertexOnEdge& s, const VertexOnEdge& t)
    {
      if (s.Edge != t.Edge)
      {
        return s.Edge < t.Edge;
      }
      const Vec3& a = points[edges[s.Edge][0]];
      const Vec3& b = points[edges[s.Edge][1]];
      const Vec3& p = points[s.Vertex];
      const Vec3& q = points[t.Vertex];
      if (!isExact && Dot(b - a, p - a) != Dot(b - a, q - a))
      {
        return Dot(b - a, p - a) < Dot(b - a, q - a);
      }
      return a < b ? p < q : q < p;
    });
}

PolygonOutlines InsertVertices(const PolygonOutlines& polygons, const std::vector<EdgeIds>& edges,
  const std::vector<VertexOnEdge>& found, std::vector<TJunction>& junctions)
{
  PolygonOutlines result;
  std::vector<Id> outline;
  std::vector<Id> split;
  for (Id k = 0; k < polygons.GetSize(); ++k)
  {
    polygons.Get(k, outline);
    split.clear();
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
      const Id from = outline[i];
      const EdgeIds edge = MakeEdge(from, outline[(i + 1) % outline.size()]);
      split.push_back(from);
      const Id e =
        static_cast<Id>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
      const auto begin =
        std::lower_bound(found.begin(), found.end(), VertexOnEdge{ e, NoId }, IsEdgeLess);
      const auto end =
        std::upper_bound(found.begin(), found.end(), VertexOnEdge{ e, NoId }, IsEdgeLess);
      const std::size_t size = split.size();
      for (auto vertex = begin; vertex != end; ++vertex)
      {
        split.push_back(vertex->Vertex);
        junctions.push_back({ polygons.Cells[k], vertex->Vertex });
      }
      if (from != edge[0])
      {
        std::reverse(split.begin() + size, split.end());
      }
    }
    result.Add(polygons.Cells[k], split);
  }
  return result;
}
} // namespace

bool SplitEdgesAtVertices(const std::vector<Vec3>& points, double tolerance,
  const ExecutionContext& context, PolygonOutlines& polygons, std::vector<TJunction>& junctions)
{
  std::vector<EdgeIds> edges;
  for (Id p = 0; p < polygons.GetSize(); ++p)
  {
    for (Id i = polygons.Offsets[p]; i < polygons.Offsets[p + 1]; ++i)
    {
      const Id next = i + 1 < polygons.Offsets[p + 1] ? i + 1 : polygons.Offsets[p];
      edges.push_back(MakeEdge(polygons.Vertices[i], polygons.Vertices[next]));
    }
  }
  SortUnique(edges);

  const Vec3 margin{ tolerance, tolerance, tolerance };
  std::vector<Box> boxes(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    boxes[e].Add(points[edges[e][0]]);
    boxes[e].Add(points[edges[e][1]]);
    boxes[e].Low = boxes[e].Low - margin;
    boxes[e].High = boxes[e].High + margin;
  }
  const BoxTree tree(boxes);

  std::vector<Id> vertices = polygons.Vertices;
  SortUnique(vertices);
  std::vector<VertexOnEdge> found;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    if (i % StepsBetweenChecks == 0 &&
      !context.Continue(static_cast<double>(i) / static_cast<double>(vertices.size()),
        "Looking for vertices on edges"))
    {
      return false;
    }
    const Id vertex = vertices[i];
    const Vec3& p = points[vertex];
    Box box;
    box.Add(p);
    tree.VisitOverlaps(box,
      [&](Id e)
      {
        if (edges[e][0] != vertex && edges[e][1] != vertex &&
          IsOnEdge(points, edges[e], p, tolerance))
        {
          found.push_back({ e, vertex });
        }
      });
  }
  if (!found.empty())
  {
    SortAlongEdges(points, edges, tolerance == 0.0, found);
    polygons = InsertVertices(polygons, edges, found, junctions);
  }
  return true;
}
} // namespace cdm
