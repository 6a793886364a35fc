// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PencilKernels.h
 * @brief The inner loops of the search for the fourth point, eight points or boxes at a time.
 *
 * Everything is relative to one vertex v of the triangle (v, b, c), so that differences are taken
 * once. With n = (b - v) x (c - v) and h the circumcenter of the triangle, a point x has
 * lambda = (|x|^2 - 2 h x) / (2 n x), and power |x|^2 - 2 m x relative to the sphere around m
 * through the triangle.
 *
 * The loops are compiled for SSE2, AVX2 and AVX-512 and chosen at run time; on other machines there
 * is a scalar one. No operation is fused, and what the loops select is verified with error bounds:
 * results do not depend on the choice.
 */
#ifndef cdmPencilKernels_h
#define cdmPencilKernels_h

#include "Types.h"

namespace cdm
{
struct Pencil
{
  /** Position of the vertex. */
  double V[3];
  /** 2 n, 2 h and 2 m. */
  double Normal[3];
  double Offset[3];
  double Center[3];
  /** Errors of 2 n x, 2 h x and 2 m x in units of |x| (Manhattan norm). */
  double HeightError;
  double OffsetError;
  double CenterError;
  /** No sphere yet: the half-space in front. */
  bool HasSphere;
};

/** Points near a vertex, relative to it; padded to a multiple of 8 with points at NaN. */
struct NearPoints
{
  const double* X;
  const double* Y;
  const double* Z;
  /** |x|^2 */
  const double* W;
  int Count;
};

struct PencilKernels
{
  /**
   * The near point of smallest lambda among those whose height is above the limit, or -1.
   */
  int (*Select)(const NearPoints&, const Pencil&, double heightLimit);
  /**
   * Near points whose power is not above the limit; their number, of which the first 64 are
   * stored.
   */
  int (*Collect)(const NearPoints&, const Pencil&, double powerLimit, int* found);
  /**
   * Those of size points (a multiple of 8) whose square distance from v is at most the limit:
   * relative to v, with their ids, in the order they come in. Returns their number; up to 8 values
   * behind them are overwritten.
   */
  int (*Filter)(const double* const* x, const Id* ids, int size, const double* v, double limit,
    double* const* out, Id* outIds);
  /** Boxes that may hold a point in front and in the sphere; lower bounds of their lambda. */
  unsigned (*TestBoxes)(const double* boxes, const Pencil&, double* bounds);
  /** Boxes whose slab may hold a point in the sphere. */
  unsigned (*TestSlabs)(const double* boxes, const double* slabs, const Pencil&);
  /** Boxes not farther from the given box (low, high) than the square root of the limit. */
  unsigned (*TestDistance)(const double* boxes, const double* box, double limit);
  /** Points of a leaf that may be in front and in the sphere. */
  unsigned (*ViewLeaf)(const double* x, const double* y, const double* z, const Pencil&);
};

/** Index of the lowest bit; the mask must not be 0. */
inline int CountTrailingZeros(unsigned mask)
{
#if defined(__GNUC__) || defined(__clang__)
  return __builtin_ctz(mask);
#else
  int count = 0;
  while (((mask >> count) & 1u) == 0)
  {
    ++count;
  }
  return count;
#endif
}

/** The fastest ones that this machine runs. */
const PencilKernels& GetPencilKernels();
} // namespace cdm

#endif
