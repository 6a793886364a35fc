// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverList.h"

#include <algorithm>

namespace cdm
{
namespace
{
bool IsSliver(double target, bool isSharp, Id tetrahedron, const RefinedMesh& mesh)
{
  return !mesh.GetTetrahedra().IsDead(tetrahedron) && mesh.GetAngle(tetrahedron) < target &&
    mesh.IsAcrossSharp(tetrahedron) == isSharp && !mesh.IsInLayer(tetrahedron);
}
} // namespace

std::vector<Sliver> FindSlivers(double target, bool isSharp, const RefinedMesh& mesh)
{
  const DynamicTetrahedralization& tetrahedra = mesh.GetTetrahedra();
  std::vector<Sliver> slivers;
  for (Id t = 0; t < tetrahedra.GetNumberOfTetrahedra(); ++t)
  {
    if (IsSliver(target, isSharp, t, mesh))
    {
      slivers.push_back({ mesh.GetAngle(t), t, tetrahedra.GetStamp(t) });
    }
  }
  std::sort(slivers.begin(), slivers.end(),
    [](const Sliver& a, const Sliver& b)
    { return a.Angle != b.Angle ? a.Angle < b.Angle : a.Tetrahedron < b.Tetrahedron; });
  return slivers;
}

std::size_t CountSlivers(double target, const RefinedMesh& mesh)
{
  std::size_t count = 0;
  for (Id t = 0; t < mesh.GetTetrahedra().GetNumberOfTetrahedra(); ++t)
  {
    count += IsSliver(target, false, t, mesh);
  }
  return count;
}

bool IsGone(const Sliver& sliver, const RefinedMesh& mesh)
{
  return mesh.GetTetrahedra().GetStamp(sliver.Tetrahedron) != sliver.Stamp;
}
} // namespace cdm
