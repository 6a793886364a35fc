// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceFlips.h
 * @brief The recursive triangle flip (thesis Def. 6.1): flips diagonals of a surface to saturation.
 *
 * A smooth edge is flipped if one of its triangles has the other's apex in its smallest sphere and
 * neither of the two that replace them has: so it cannot be flipped back at once. The edge has to
 * be convex. Either both diagonals are closer to each other than the flatness, or the surface stays
 * smooth by the accuracy angle. On curved facets flips may go in circles: their number is
 * bounded for each triangle and each new point.
 */
#ifndef cdmSurfaceFlips_h
#define cdmSurfaceFlips_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Surface/RefinableSurface.h"

#include <cstdint>
#include <vector>

namespace cdm
{
class SurfaceFlips
{
public:
  /**
   * Surface and points are shared with the caller.
   * @param flatness in model units
   * @param accuracyAngle in degrees
   */
  SurfaceFlips(RefinableSurface& surface, const std::vector<Vec3>& points, double flatness,
    double accuracyAngle);

  /** Whether the diagonal of the two triangles at a use may be flipped. */
  bool CanFlip(Id use) const;

  /** Whether a flip makes a locally bad edge a good one. */
  bool ShouldFlip(Id use) const;

  void Flip(Id use);

  /**
   * Flips all diagonals that should be, beginning with some uses; calls onFlip(triangle) for both
   * triangles.
   */
  template <typename OnFlip>
  void Saturate(std::vector<Id>& uses, const OnFlip& onFlip)
  {
    while (!uses.empty())
    {
      const Id use = uses.back();
      uses.pop_back();
      if (!this->ShouldFlip(use))
      {
        continue;
      }
      const Id t = use / 3;
      const Id u = this->Surface.GetTriangle(t).Adjacent[use % 3] / 3;
      this->Flip(use);
      onFlip(t);
      onFlip(u);
      // The four outer edges of the quadrilateral.
      uses.push_back(3 * t);
      uses.push_back(3 * t + 2);
      uses.push_back(3 * u);
      uses.push_back(3 * u + 1);
    }
  }

  /** A new point allows for more flips. */
  void AddPoint();

  Id GetNumberOfFlips() const { return this->NumberOfFlips; }

private:
  RefinableSurface& Surface;
  const std::vector<Vec3>& Points;
  double Flatness;
  double AccuracyAngle;
  Id NumberOfFlips = 0;
  /** Number of flips that are left. */
  std::int64_t Budget;
};
} // namespace cdm

#endif
