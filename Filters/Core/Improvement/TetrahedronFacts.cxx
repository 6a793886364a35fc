// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/TetrahedronFacts.h"

#include "Core/Geometry/Measures.h"

namespace cdm
{
TetrahedronFacts::Known& TetrahedronFacts::Get(Id tetrahedron)
{
  if (static_cast<std::size_t>(tetrahedron) >= this->Facts.size())
  {
    this->Facts.resize(this->Mesh.GetMesh().Tetrahedra.size());
  }
  Known& known = this->Facts[tetrahedron];
  if (known.Stamp != this->Mesh.GetStamp(tetrahedron))
  {
    known = {};
    known.Stamp = this->Mesh.GetStamp(tetrahedron);
  }
  return known;
}

std::array<Vec3, 4> TetrahedronFacts::GetVertices(Id tetrahedron) const
{
  const TetrahedronIds& ids = this->Mesh.GetMesh().Tetrahedra[tetrahedron];
  return { this->Mesh.GetPoint(ids[0]), this->Mesh.GetPoint(ids[1]), this->Mesh.GetPoint(ids[2]),
    this->Mesh.GetPoint(ids[3]) };
}

double TetrahedronFacts::GetAngle(Id tetrahedron)
{
  Known& known = this->Get(tetrahedron);
  if (known.Angle < 0.0)
  {
    const std::array<Vec3, 4> v = this->GetVertices(tetrahedron);
    known.Angle = GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]);
  }
  return known.Angle;
}

TetrahedronFault TetrahedronFacts::GetFault(Id tetrahedron, double& severity)
{
  Known& known = this->Get(tetrahedron);
  if (!known.Fault)
  {
    Vec3 target;
    known.Fault = this->Limits.Find(this->GetVertices(tetrahedron), true, target, known.Severity);
  }
  severity = known.Severity;
  return *known.Fault;
}

bool TetrahedronFacts::IsInLayer(Id tetrahedron, const BoundaryShape& shape)
{
  Known& known = this->Get(tetrahedron);
  if (!known.IsInLayer)
  {
    const TetMesh& mesh = this->Mesh.GetMesh();
    known.IsInLayer =
      shape.Layers.IsAcross(mesh.Tetrahedra[tetrahedron], mesh.Regions[tetrahedron]);
  }
  return *known.IsInLayer;
}

bool TetrahedronFacts::IsAcrossSharp(Id tetrahedron, const BoundaryShape& shape)
{
  Known& known = this->Get(tetrahedron);
  if (!known.IsAcrossSharp)
  {
    known.IsAcrossSharp = shape.Sharp.IsAcross(this->Mesh.GetMesh().Tetrahedra[tetrahedron]);
  }
  return *known.IsAcrossSharp;
}
} // namespace cdm
