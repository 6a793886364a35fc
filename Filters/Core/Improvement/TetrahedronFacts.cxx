// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/TetrahedronFacts.h"

#include "Core/Geometry/Measures.h"

namespace cdm
{
/** What is known so far; a copy of it, in the scratch, while the cache is frozen. */
TetrahedronFacts::Known& TetrahedronFacts::Get(Id tetrahedron, Known& scratch)
{
  const std::int64_t stamp = this->Mesh.GetStamp(tetrahedron);
  const bool isIn = static_cast<std::size_t>(tetrahedron) < this->Facts.size();
  if (this->IsFrozen)
  {
    if (isIn && this->Facts[tetrahedron].Stamp == stamp)
    {
      scratch = this->Facts[tetrahedron];
    }
    return scratch;
  }
  if (!isIn)
  {
    this->Facts.resize(this->Mesh.GetMesh().Tetrahedra.size());
  }
  Known& known = this->Facts[tetrahedron];
  if (known.Stamp != stamp)
  {
    known = {};
    known.Stamp = stamp;
  }
  return known;
}

void TetrahedronFacts::Forget(std::int64_t first)
{
  for (Known& known : this->Facts)
  {
    if (known.Stamp >= first)
    {
      known = {};
    }
  }
}

double TetrahedronFacts::GetAngle(Id tetrahedron)
{
  Known scratch;
  Known& known = this->Get(tetrahedron, scratch);
  if (known.Angle < 0.0)
  {
    const auto [a, b, c, d] = this->Mesh.GetCorners(tetrahedron);
    known.Angle = GetSmallestDihedralAngle(a, b, c, d);
  }
  return known.Angle;
}

TetrahedronFault TetrahedronFacts::GetFault(Id tetrahedron)
{
  Known scratch;
  Known& known = this->Get(tetrahedron, scratch);
  if (!known.Fault)
  {
    Vec3 target;
    double severity = 0.0;
    known.Fault = this->Limits.Find(this->Mesh.GetCorners(tetrahedron), true, target, severity);
  }
  return *known.Fault;
}

bool TetrahedronFacts::IsInLayer(Id tetrahedron, const BoundaryShape& shape)
{
  Known scratch;
  Known& known = this->Get(tetrahedron, scratch);
  if (!known.IsInLayer)
  {
    const TetMesh& mesh = this->Mesh.GetMesh();
    known.IsInLayer =
      shape.Layers.IsAcross(mesh.Tetrahedra[tetrahedron], mesh.Regions[tetrahedron]);
  }
  return *known.IsInLayer;
}

bool TetrahedronFacts::IsAcrossSharp(Id tetrahedron, const BoundaryShape& shape, SharpAngleUse use)
{
  Known scratch;
  Known& known = this->Get(tetrahedron, scratch);
  std::optional<bool>& isAcross =
    use == SharpAngleUse::Sliver ? known.IsSharpSliver : known.IsAcrossSharp;
  if (!isAcross)
  {
    isAcross = shape.Sharp.IsAcross(this->Mesh.GetMesh().Tetrahedra[tetrahedron], use);
  }
  return *isAcross;
}
} // namespace cdm
