// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TriangleProofs.h"

#include "Core/Geometry/Predicates.h"

#include <algorithm>

namespace cdm
{
void TriangleProofs::Set(
  Id triangle, const TriangleIds& points, const SurfaceDelaunayTest::SphereProof& proof)
{
  this->Balls.Set(triangle, proof.Center, proof.Radius);
  if (proof.IsLoose)
  {
    this->LooseProofs[triangle] = { points, proof.HasPoint, proof.Point };
  }
  else
  {
    this->LooseProofs.erase(triangle);
  }
}

void TriangleProofs::Remove(Id triangle)
{
  this->Balls.Remove(triangle);
  this->LooseProofs.erase(triangle);
}

void TriangleProofs::Find(const Vec3& position, std::vector<Id>& triangles)
{
  this->Balls.Find(position, triangles);
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(),
                    [&](Id t)
                    {
                      const auto proof = this->LooseProofs.find(t);
                      return proof != this->LooseProofs.end() &&
                        this->IsOutside(proof->second, position);
                    }),
    triangles.end());
}

bool TriangleProofs::IsOutside(const LooseProof& proof, const Vec3& position) const
{
  const Vec3& a = this->Points[proof.Triangle[0]];
  const Vec3& b = this->Points[proof.Triangle[1]];
  const Vec3& c = this->Points[proof.Triangle[2]];
  if (!proof.HasPoint)
  {
    return InEquatorialSphere(a, b, c, position) < 0;
  }
  const int side = Orientation(a, b, c, proof.Point);
  return side * InSphere(a, b, c, proof.Point, position) < 0;
}
} // namespace cdm
