// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/FacetPolygons.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/EdgeUses.h"

namespace cdm
{
FacetPolygons::FacetPolygons(const TriangleMesh& surface, std::size_t numberOfPoints)
  : Surface(surface), Others(3 * surface.Triangles.size(), NoId)
{
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, numberOfPoints);
  for (std::size_t begin = 0; begin < uses.size();)
  {
    const std::size_t end = FindEndOfEdge(uses, begin);
    if (end - begin == 2)
    {
      this->Others[uses[begin].Use] = uses[begin + 1].Use / 3;
      this->Others[uses[begin + 1].Use] = uses[begin].Use / 3;
    }
    begin = end;
  }
}

bool FacetPolygons::HaveSameLabels(Id s, Id t, Id a, Id b) const
{
  if (this->Surface.Labels.empty())
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

std::vector<TriangleIds> MakePulledFan(
  const std::vector<Vec3>& points, const TriangleIds& triangle, const std::vector<Id>& others)
{
  const Vec3& a = points[triangle[0]];
  std::vector<Id> outline(others);
  outline.insert(outline.end(), triangle.begin() + 1, triangle.end());
  // Directions from the first point in the plane of the triangle, in its projection.
  int axis = 0;
  while (ProjectedOrientation(axis, a, points[triangle[1]], points[triangle[2]]) == 0)
  {
    ++axis;
  }
  const int turn = ProjectedOrientation(axis, a, points[triangle[1]], points[triangle[2]]);
  std::sort(outline.begin(), outline.end(),
    [&](Id x, Id y) { return ProjectedOrientation(axis, a, points[x], points[y]) == turn; });
  outline.insert(outline.begin(), triangle[0]);
  const std::size_t count = outline.size();
  const std::size_t lowest =
    static_cast<std::size_t>(std::min_element(outline.begin(), outline.end()) - outline.begin());
  std::vector<TriangleIds> fan;
  for (std::size_t i = 1; i + 1 < count; ++i)
  {
    fan.push_back(
      { outline[lowest], outline[(lowest + i) % count], outline[(lowest + i + 1) % count] });
  }
  return fan;
}
} // namespace cdm
