// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/SurfaceSides.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>

namespace cdm
{
namespace
{
std::vector<TriangleAtEdge> CollectEdgeUses(const TriangleMesh& surface)
{
  std::vector<TriangleAtEdge> uses;
  uses.reserve(3 * surface.Triangles.size());
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& triangle = surface.Triangles[t];
    for (int i = 0; i < 3; ++i)
    {
      const Id a = triangle[i];
      const Id b = triangle[(i + 1) % 3];
      uses.push_back({ MakeEdge(a, b), static_cast<Id>(t), triangle[(i + 2) % 3], a < b });
    }
  }
  std::sort(uses.begin(), uses.end(),
    [](const TriangleAtEdge& x, const TriangleAtEdge& y)
    { return x.Edge != y.Edge ? x.Edge < y.Edge : x.Triangle < y.Triangle; });
  return uses;
}

/** Sorts the triangles around an edge by their angle from the first one, exactly. */
class AngleOrder
{
public:
  AngleOrder(const std::vector<Vec3>& points, const TriangleAtEdge& first)
    : Points(points), A(points[first.Edge[0]]), B(points[first.Edge[1]]),
      Reference(points[first.Apex])
  {
  }

  bool operator()(const TriangleAtEdge& x, const TriangleAtEdge& y) const
  {
    const int i = this->GetQuarter(x);
    const int j = this->GetQuarter(y);
    if (i != j)
    {
      return i < j;
    }
    const int side = Orientation(this->A, this->B, this->Points[x.Apex], this->Points[y.Apex]);
    return side != 0 ? side > 0 : x.Triangle < y.Triangle;
  }

private:
  /** 0: along the reference; 1: up to 180 degrees; 2: opposite to it; 3: beyond. */
  int GetQuarter(const TriangleAtEdge& use) const
  {
    const Vec3& apex = this->Points[use.Apex];
    const int side = Orientation(this->A, this->B, this->Reference, apex);
    if (side != 0)
    {
      return side > 0 ? 1 : 3;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const int turn = ProjectedOrientation(axis, this->A, this->B, this->Reference);
      if (turn != 0)
      {
        return turn == ProjectedOrientation(axis, this->A, this->B, apex) ? 0 : 2;
      }
    }
    return 0;
  }

  const std::vector<Vec3>& Points;
  Vec3 A;
  Vec3 B;
  Vec3 Reference;
};
} // namespace

void SortAroundEdge(const std::vector<Vec3>& points, TriangleAtEdge* begin, TriangleAtEdge* end)
{
  std::sort(begin, end, AngleOrder(points, *begin));
}

SurfaceSides FindSurfaceSides(const TriangleMesh& surface)
{
  const Id numberOfTriangles = static_cast<Id>(surface.Triangles.size());
  SurfaceSides result;
  DisjointSets sides(2 * surface.Triangles.size());
  DisjointSets components(surface.Triangles.size());
  std::vector<TriangleAtEdge> uses = CollectEdgeUses(surface);
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    while (end < uses.size() && uses[end].Edge == uses[begin].Edge)
    {
      ++end;
    }
    if (end - begin == 1)
    {
      result.OpenTriangles.push_back(uses[begin].Triangle);
    }
    if (end - begin > 2)
    {
      SortAroundEdge(surface.Points, uses.data() + begin, uses.data() + end);
    }
    for (std::size_t i = begin; i < end; ++i)
    {
      const TriangleAtEdge& use = uses[i];
      const TriangleAtEdge& next = uses[i + 1 < end ? i + 1 : begin];
      // The side that faces growing angles meets the next triangle's side that faces falling ones.
      sides.Unite(
        2 * use.Triangle + (use.IsForward ? 0 : 1), 2 * next.Triangle + (next.IsForward ? 1 : 0));
      components.Unite(use.Triangle, next.Triangle);
    }
  }
  SortUnique(result.OpenTriangles);

  // Number the shells, and sum up what each encloses: the outer shell of a component encloses minus
  // the sum of all others, so that it is the smallest whatever the rounding.
  result.Shells.assign(2 * surface.Triangles.size(), NoId);
  std::vector<double> volumes;
  std::vector<Id> shellComponents;
  const Vec3 origin = surface.Points.empty() ? Vec3{} : surface.Points.front();
  for (Id side = 0; side < 2 * numberOfTriangles; ++side)
  {
    const Id root = sides.Find(side);
    if (root == side)
    {
      result.Shells[side] = static_cast<Id>(volumes.size());
      volumes.push_back(0.0);
      shellComponents.push_back(components.Find(side / 2));
    }
    const Id shell = result.Shells[root];
    result.Shells[side] = shell;
    const TriangleIds& triangle = surface.Triangles[side / 2];
    const Vec3 a = surface.Points[triangle[0]] - origin;
    const Vec3 b = surface.Points[triangle[1]] - origin;
    const Vec3 c = surface.Points[triangle[2]] - origin;
    const double volume = Dot(a, Cross(b, c));
    volumes[shell] += side % 2 == 0 ? -volume : volume;
  }
  Id numberOfComponents = 0;
  result.Components.resize(surface.Triangles.size());
  for (Id triangle = 0; triangle < numberOfTriangles; ++triangle)
  {
    const Id first = components.Find(triangle);
    result.Components[triangle] =
      first == triangle ? numberOfComponents++ : result.Components[first];
  }
  std::vector<Id> outerShells(surface.Triangles.size(), NoId);
  for (std::size_t shell = 0; shell < volumes.size(); ++shell)
  {
    Id& outer = outerShells[shellComponents[shell]];
    if (outer == NoId || volumes[shell] < volumes[outer])
    {
      outer = static_cast<Id>(shell);
    }
  }
  std::vector<char> isOpenComponent(surface.Triangles.size(), 0);
  for (Id triangle : result.OpenTriangles)
  {
    isOpenComponent[components.Find(triangle)] = 1;
  }
  for (std::size_t shell = 0; shell < volumes.size(); ++shell)
  {
    result.IsOuter.push_back(outerShells[shellComponents[shell]] == static_cast<Id>(shell));
    result.IsOpen.push_back(isOpenComponent[shellComponents[shell]]);
  }
  return result;
}
} // namespace cdm
