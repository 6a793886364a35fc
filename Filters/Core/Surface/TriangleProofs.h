// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleProofs.h
 * @brief Empty spheres that prove triangles to be Delaunay, and which of them a new point is in.
 *
 * Balls in a BallIndex stand for the spheres. A ball is a little larger than its sphere. That of an
 * almost flat one or of a needle holds far more: there an exact predicate decides. In thin sheets
 * a point is in the balls of some forty such triangles, nearly always in vain.
 *
 * Guarantees: a triangle that is not found stays Delaunay if a point is added at the position.
 */
#ifndef cdmTriangleProofs_h
#define cdmTriangleProofs_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Search/BallIndex.h"
#include "Core/Surface/SurfaceDelaunayTest.h"

#include <unordered_map>
#include <vector>

namespace cdm
{
class TriangleProofs
{
public:
  /** The points have to outlive the object. Those of a triangle with a proof must not move. */
  explicit TriangleProofs(const std::vector<Vec3>& points) : Points(points) {}

  /** The proof of a triangle, in place of the one it had. */
  void Set(Id triangle, const TriangleIds& points, const SurfaceDelaunayTest::SphereProof& proof);
  void Remove(Id triangle);

  /** Triangles that may not be Delaunay if a point is added at the position. */
  void Find(const Vec3& position, std::vector<Id>& triangles);

private:
  /** A triangle, and a fourth point on its sphere, or none for the smallest sphere. */
  struct LooseProof
  {
    TriangleIds Triangle;
    bool HasPoint;
    Vec3 Point;
  };

  bool IsOutside(const LooseProof& proof, const Vec3& position) const;

  const std::vector<Vec3>& Points;
  BallIndex Balls;
  std::unordered_map<Id, LooseProof> LooseProofs;
};
} // namespace cdm

#endif
