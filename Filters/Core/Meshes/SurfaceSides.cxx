// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/SurfaceSides.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/EdgeUses.h"

#include <algorithm>

namespace cdm
{
namespace
{
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
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  std::vector<TriangleAtEdge> around;
  for (auto begin = uses.begin(), end = begin; begin != uses.end(); begin = end)
  {
    around.clear();
    for (; end != uses.end() && end->Edge == begin->Edge; ++end)
    {
      const TriangleIds& triangle = surface.Triangles[end->Use / 3];
      const Id first = triangle[end->Use % 3];
      const Id second = triangle[(end->Use + 1) % 3];
      const Id apex = triangle[(end->Use + 2) % 3];
      around.push_back({ begin->GetPoints(), end->Use / 3, apex, first < second });
    }
    if (around.size() == 1)
    {
      result.OpenTriangles.push_back(around[0].Triangle);
    }
    if (around.size() > 2)
    {
      SortAroundEdge(surface.Points, around.data(), around.data() + around.size());
    }
    for (std::size_t i = 0; i < around.size(); ++i)
    {
      const TriangleAtEdge& use = around[i];
      const TriangleAtEdge& next = around[i + 1 < around.size() ? i + 1 : 0];
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
