// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizingField.h
 * @brief How long edges are to be: the control function of the thesis (3.3), and its gradation.
 *
 * The spacing around a position is an ellipsoid: a sphere (one length), an ellipsoid along the axes
 * (three lengths) or one in any position (a tensor). F(x, d) of eq. 3.20 is its radius in direction
 * d. A sizing field gives it for each position, of the domain or not.
 *
 * BoundGradation() lowers sizes given at the points of cells until they grow nowhere faster than
 * wanted: the largest sizes below the given ones with |h(a) - h(b)| <= g |a - b| for any two points
 * of a cell, from the smallest size on, as Dijkstra's algorithm does, but for many points of
 * similar size at a time, which threads share: points that are lowered meanwhile are visited again.
 * Which thread is first does not matter: the largest such sizes are unique, with their rounding
 * too.
 *
 * Cost: O(n log n) for n points in cells of bounded size, of which some are visited twice; 40 bytes
 * per point.
 * References: H. Borouchaki, F. Hecht, P. J. Frey, "Mesh gradation control", 1998,
 * doi:10.1002/(SICI)1097-0207(19981130)43:6<1143::AID-NME470>3.0.CO;2-I (the h-variation);
 * P.-O. Persson, "Mesh size functions for implicit geometries and PDE-based gradient limiting",
 * 2006, doi:10.1007/s00366-006-0014-1 (the largest field below one that has bounded slope).
 */
#ifndef cdmSizingField_h
#define cdmSizingField_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Vec3.h"
#include "Core/Sizing/SizingMinima.h"

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace cdm
{
/** The spacing around one position; lengths are positive, in model units. */
class LocalSpacing
{
public:
  /** The same in all directions; implicit, so that a length is a spacing. */
  LocalSpacing(double length) : LocalSpacing(Vec3{ length, length, length }) {}
  /** One length for each axis. */
  explicit LocalSpacing(const Vec3& lengths);
  /** Lengths in three directions, which are orthogonal and of length 1. */
  LocalSpacing(const Vec3& lengths, const Vec3 (&directions)[3]);
  /** One length along a direction of length 1, another one across it. */
  LocalSpacing(const Vec3& direction, double along, double across);

  /** The largest spacing that is nowhere longer than this one and the length. */
  LocalSpacing GetLimited(double length) const;

  double GetSmallest() const { return this->Smallest; }
  double GetLargest() const { return this->Largest; }
  /** Half the extents of a box around the ellipsoid. */
  const Vec3& GetExtents() const { return this->Extents; }
  /** How many unit cells of this spacing fill a unit of volume. */
  double GetDensity() const { return Dot(this->Rows[0], Cross(this->Rows[1], this->Rows[2])); }
  /** The spacing in a direction of any length but zero. */
  double GetAlong(const Vec3& direction) const
  {
    return Norm(direction) / Norm(this->ToUnits(direction));
  }
  /** An offset measured in spacings: the ellipsoid becomes the unit sphere. */
  Vec3 ToUnits(const Vec3& offset) const
  {
    return { Dot(this->Rows[0], offset), Dot(this->Rows[1], offset), Dot(this->Rows[2], offset) };
  }

private:
  /** Inverse of the spacing tensor, symmetric. */
  Vec3 Rows[3];
  Vec3 Extents;
  double Smallest;
  double Largest;
};

/**
 * The spacing at each position. Edges are to be no longer than the spacing anywhere along them, and
 * those of a triangle or a tetrahedron than anywhere in it. They are asked at corners, the middles
 * of edges and the center; with SizingMinima also wherever else they can be smallest. Of a field
 * that is only a function, and of Limit(), what is small between these is not seen.
 */
class SizingField
{
public:
  /** Stages call it from several threads at once; the same position always has the same spacing. */
  using Function = std::function<LocalSpacing(const Vec3&)>;
  using Predicate = std::function<bool(const Vec3& position, const LocalSpacing& spacing)>;

  /** No field: edges may have any length. */
  SizingField() = default;
  /** Implicit, so that a function of a position is a sizing field. */
  template <class Callable,
    class = std::enable_if_t<std::is_convertible_v<Callable, Function> &&
      !std::is_same_v<std::decay_t<Callable>, SizingField>>>
  SizingField(Callable&& spacing) : Spacing(std::forward<Callable>(spacing))
  {
  }
  SizingField(Function spacing, std::shared_ptr<const SizingMinima> minima)
    : Spacing(std::move(spacing)), Minima(std::move(minima))
  {
  }

  /** A longest length at each position. */
  using LengthFunction = std::function<double(const Vec3&)>;
  /** Lowers the spacing to these lengths, where it is longer; without a field they are one. */
  void Limit(LengthFunction lengths);

  explicit operator bool() const { return static_cast<bool>(this->Spacing); }
  LocalSpacing operator()(const Vec3& position) const
  {
    return this->Lengths ? this->Spacing(position).GetLimited(this->Lengths(position))
                         : this->Spacing(position);
  }

  /** Whether somewhere in a triangle a spacing with a length below this one fulfils a condition. */
  bool AnyBelow(
    const std::array<Vec3, 3>& triangle, double length, const Predicate& isSought) const;
  bool AnyBelow(
    const std::array<Vec3, 4>& tetrahedron, double length, const Predicate& isSought) const;
  /** Calls visit for positions in a box where a length is below those that were visited before. */
  void VisitMinima(const Box& box, double length,
    const std::function<void(const LocalSpacing& spacing)>& visit) const;

private:
  template <std::size_t Size>
  bool AnyBelowIn(
    const std::array<Vec3, Size>& corners, double length, const Predicate& isSought) const;

  Function Spacing;
  /** Where Spacing is smallest; Lengths do not count. */
  std::shared_ptr<const SizingMinima> Minima;
  LengthFunction Lengths;
};

struct GradationOptions
{
  /** How much larger sizes may be for each unit of distance. > 0. */
  double Gradation = 0.3;
};

/** One size for each point. */
Status BoundGradation(const SizingCells& cells, const GradationOptions& options,
  const ExecutionContext& context, std::vector<double>& sizes);
} // namespace cdm

#endif
