// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Box.h
 * @brief Axis-parallel closed box.
 */
#ifndef cdmBox_h
#define cdmBox_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <algorithm>
#include <vector>

namespace cdm
{
/** Empty (inverted) when default constructed. */
struct Box
{
  Vec3 Low{ Infinity, Infinity, Infinity };
  Vec3 High{ -Infinity, -Infinity, -Infinity };

  static Box MakeInfinite()
  {
    const Box none;
    return { none.High, none.Low };
  }
  static Box MakeAround(const Vec3& center, double radius)
  {
    const Vec3 half{ radius, radius, radius };
    return { center - half, center + half };
  }

  bool IsEmpty() const { return this->Low.X > this->High.X; }

  void Add(const Vec3& p)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Low[axis] = std::min(this->Low[axis], p[axis]);
      this->High[axis] = std::max(this->High[axis], p[axis]);
    }
  }
  void Add(const Box& box)
  {
    this->Add(box.Low);
    this->Add(box.High);
  }
  /** Squared distance of a point from the box; 0 inside. */
  double GetSquaredDistance(const Vec3& p) const
  {
    double distance = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double nearest =
        std::min(std::max(p[axis], this->Low[axis]), this->High[axis]) - p[axis];
      distance += nearest * nearest;
    }
    return distance;
  }
  bool Overlaps(const Box& box) const
  {
    return this->Low.X <= box.High.X && box.Low.X <= this->High.X && this->Low.Y <= box.High.Y &&
      box.Low.Y <= this->High.Y && this->Low.Z <= box.High.Z && box.Low.Z <= this->High.Z;
  }
};

/** The box of a triangle. */
inline Box GetBox(const std::vector<Vec3>& points, const TriangleIds& t)
{
  Box box;
  for (const Id id : t)
  {
    box.Add(points[id]);
  }
  return box;
}

/** The box of each triangle. */
inline std::vector<Box> MakeBoxes(
  const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles)
{
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
  {
    boxes[t] = GetBox(points, triangles[t]);
  }
  return boxes;
}
} // namespace cdm

#endif
