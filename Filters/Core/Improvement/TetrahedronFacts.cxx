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
    if (isIn && this->Facts[tetrahedron].GetStamp() == stamp)
    {
      scratch = this->Facts[tetrahedron];
    }
    return scratch;
  }
  if (!isIn)
  {
    this->MakeRoom();
  }
  Known& known = this->Facts[tetrahedron];
  if (known.GetStamp() != stamp)
  {
    known = Known(stamp);
  }
  return known;
}

void TetrahedronFacts::Forget(const MeshMoment& moment)
{
  this->Mesh.VisitMadeSince(moment, this->Marks,
    [&](Id t)
    {
      if (static_cast<std::size_t>(t) < this->Facts.size() &&
        this->Facts[t].GetStamp() >= moment.NextStamp)
      {
        this->Facts[t] = Known();
      }
    });
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
  if (known.Fault == 0)
  {
    Vec3 target;
    double severity = 0.0;
    const TetrahedronFault fault =
      this->Limits.Find(this->Mesh.GetCorners(tetrahedron), true, target, severity);
    known.Fault = static_cast<unsigned>(fault) + 1;
  }
  return static_cast<TetrahedronFault>(known.Fault - 1);
}

bool TetrahedronFacts::IsInLayer(Id tetrahedron, const BoundaryShape& shape)
{
  Known scratch;
  Known& known = this->Get(tetrahedron, scratch);
  if (known.IsInLayer == 0)
  {
    const TetMesh& mesh = this->Mesh.GetMesh();
    known.IsInLayer =
      shape.Layers.IsAcross(mesh.Tetrahedra[tetrahedron], mesh.Regions[tetrahedron]) ? 2 : 1;
  }
  return known.IsInLayer == 2;
}

bool TetrahedronFacts::IsAcrossSharp(Id tetrahedron, const BoundaryShape& shape, SharpAngleUse use)
{
  Known scratch;
  Known& known = this->Get(tetrahedron, scratch);
  const auto find = [&]
  { return shape.Sharp.IsAcross(this->Mesh.GetMesh().Tetrahedra[tetrahedron], use) ? 2 : 1; };
  if (use == SharpAngleUse::Sliver)
  {
    known.IsSharpSliver = known.IsSharpSliver == 0 ? find() : known.IsSharpSliver;
    return known.IsSharpSliver == 2;
  }
  known.IsAcrossSharp = known.IsAcrossSharp == 0 ? find() : known.IsAcrossSharp;
  return known.IsAcrossSharp == 2;
}
} // namespace cdm
