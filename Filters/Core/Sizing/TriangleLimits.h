// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleLimits.h
 * @brief Limits of the size and the angles of triangles of a surface.
 */
#ifndef cdmTriangleLimits_h
#define cdmTriangleLimits_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Sizing/SizingField.h"

#include <array>

namespace cdm
{
struct TriangleLimits
{
  /** Model units; 0: no limit. */
  double MaximumEdgeLength = 0.0;
  /** Square model units; 0: no limit. */
  double MaximumArea = 0.0;
  /** Degrees; 0: no limit. Angles between two structural edges are as they are. */
  double MinimumAngle = 0.0;
  /** May be empty. No edge is to be longer than the largest length anywhere in the triangle. */
  SizingField Sizing;

  bool HasAny() const
  {
    return this->MaximumEdgeLength > 0.0 || this->MaximumArea > 0.0 || this->MinimumAngle > 0.0 ||
      this->Sizing;
  }

  /**
   * @param isStructural for the edges from each corner to the next one
   * @param isAngleTested whether the smallest angle counts
   * @param edge the structural edge to split first if the triangle is too large, the longest of
   * them;
   *        otherwise NoId
   */
  bool IsTooCoarse(const std::array<Vec3, 3>& corners, const std::array<bool, 3>& isStructural,
    bool isAngleTested, Id& edge) const;
};
} // namespace cdm

#endif
