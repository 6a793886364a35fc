// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverList.h"

#include <algorithm>

namespace cdm
{
namespace
{
/** Whether a tetrahedron with an angle below the target counts as a sliver. */
bool IsSliver(bool isSharp, Id tetrahedron, const RefinedMesh& mesh)
{
  return mesh.IsAcrossSharp(tetrahedron, SharpAngleUse::Sliver) == isSharp &&
    !mesh.IsInLayer(tetrahedron);
}
} // namespace

std::vector<Sliver> FindSlivers(double target, bool isSharp, const RefinedMesh& mesh)
{
  const DynamicTetrahedralization& tetrahedra = mesh.GetTetrahedra();
  std::vector<Sliver> slivers;
  for (Id t : mesh.FindFlatter(target))
  {
    if (IsSliver(isSharp, t, mesh))
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
  const std::vector<Id> flatter = mesh.FindFlatter(target);
  return std::count_if(
    flatter.begin(), flatter.end(), [&mesh](Id t) { return IsSliver(false, t, mesh); });
}

bool IsGone(const Sliver& sliver, const RefinedMesh& mesh)
{
  return mesh.GetTetrahedra().GetStamp(sliver.Tetrahedron) != sliver.Stamp;
}

bool IsHopeless(const Sliver& sliver, SliverAttempt last, RefinedMesh& mesh)
{
  const TetrahedronIds& ids = mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
  return mesh.GetMemory().IsHopeless(mesh.GetNames(ids), last);
}

void SetHopeless(const Sliver& sliver, SliverAttempt last, RefinedMesh& mesh)
{
  const TetrahedronIds& ids = mesh.GetMesh().Tetrahedra[sliver.Tetrahedron];
  mesh.GetMemory().SetHopeless(mesh.GetNames(ids), last);
}
} // namespace cdm
