// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FacetForm.h
 * @brief Tests whether a box may hold points in conflict with a facet of the hull: beyond it, or in
 * its plane.
 *
 * In floating point with error bounds: an answer that is given is right. In the plane of the facet
 * the sphere of its tetrahedron decides.
 */
#ifndef cdmFacetForm_h
#define cdmFacetForm_h

#include "Core/Basics/Vec3.h"
#include "Core/Geometry/SphereForm.h"

namespace cdm
{
class FacetForm
{
public:
  /** A facet, counter-clockwise seen from outside, and the apex of its tetrahedron. */
  FacetForm(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& apex);

  /** False only if no point of the box is in conflict. */
  bool MayTouch(const Vec3& low, const Vec3& high) const;

  /** +1 in conflict, -1 not; 0: too close to tell. */
  int GetSide(const Vec3& point) const;

private:
  Vec3 A;
  Vec3 B;
  Vec3 C;
  Vec3 Normal;
  SphereForm Sphere;
  double Error;
};
} // namespace cdm

#endif
