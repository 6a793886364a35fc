// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverList.h"

#include <algorithm>

namespace cdm
{
std::vector<Sliver> FindSlivers(double target, SliverPlace place, const RefinedMesh& mesh)
{
  const bool isSharp = place == SliverPlace::SharpAngle;
  const DynamicTetrahedralization& tetrahedra = mesh.GetTetrahedra();
  std::vector<Sliver> slivers;
  for (Id t : isSharp ? mesh.FindFlatter(target) : mesh.FindSlivers(target))
  {
    if (!isSharp || (mesh.IsAcrossSharp(t, SharpAngleUse::Sliver) && !mesh.IsInLayer(t)))
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
  return mesh.FindSlivers(target).size();
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
