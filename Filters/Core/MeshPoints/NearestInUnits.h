// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NearestInUnits.h
 * @brief Visitor of a PointOctree: the nearest point to a position, measured in its spacing.
 */
#ifndef cdmNearestInUnits_h
#define cdmNearestInUnits_h

#include "Core/Basics/Types.h"
#include "Core/Geometry/Box.h"
#include "Core/Sizing/SizingField.h"

#include <algorithm>

namespace cdm
{
/** The nearest of the points in an octree, measured in spacings, if nearer than a limit. */
class NearestInUnits
{
public:
  NearestInUnits(const Vec3& position, const LocalSpacing& spacing, double limit)
    : Distance(limit), Position(position), Spacing(spacing)
  {
  }

  double Order(const Box& box) const
  {
    double bound = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double x = this->Position[axis];
      const double offset = std::max({ box.Low[axis] - x, x - box.High[axis], 0.0 });
      bound = std::max(bound, offset / this->Spacing.GetExtents()[axis]);
    }
    return bound < this->Distance ? bound : Infinity;
  }

  void Visit(Id id, const Vec3& p)
  {
    const double distance = Norm(this->Spacing.ToUnits(p - this->Position));
    if (distance < this->Distance)
    {
      this->Distance = distance;
      this->Found = id;
    }
  }

  double Distance;
  Id Found = NoId;

private:
  Vec3 Position;
  LocalSpacing Spacing;
};
} // namespace cdm

#endif
