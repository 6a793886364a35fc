// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GridBlock.h
 * @brief Finds a rectilinear grid among points, and makes its Delaunay tetrahedralization at once.
 *
 * Every box of a complete rectilinear grid is a cell of the Delaunay subdivision of its points. Its
 * eight points lie on one sphere, which is the most expensive that there is for predicates, and
 * needs none: the pulling rule makes six tetrahedra of it, by the order of its corners.
 *
 * Method:
 *  1. no grid if coordinates hardly repeat in a sample of the points;
 *  2. lines: the values of a coordinate that belong to a quarter as many points, at least, as the
 *     lines that half of the points lie on; points with a line on every axis are in the lattice;
 *  3. as long as a point is missing in the lattice, the line that misses most of its points is
 *     dropped. Points that are not in the block in the end are left to be inserted;
 *  4. six tetrahedra for each box, from a table of the 64 ways to pull its corners: the lowest one
 *     decides the apex, and the lowest ones of the three faces opposite to it their diagonals.
 *     Beyond the triangles of the hull lie tetrahedra with the vertex at infinity.
 *
 * Guarantees: the tetrahedra are those of the pulling rule (thesis 6.4.3,
 * DelaunayTetrahedralization.h), in the same order for any number of threads.
 * Failure: no block, if it would have less than an eighth of the points: a few points that are
 * missing here and there in a large grid leave none.
 * Cost: O(n). Beside the insertion of the points, which takes 3 to 7 us for each: 0.1 us per point
 * to find a block or that there is none, nothing where there are no lines, and 0.4 us for its
 * tetrahedra.
 */
#ifndef cdmGridBlock_h
#define cdmGridBlock_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/RawVector.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"

#include <array>
#include <vector>

namespace cdm
{
struct GridBlock
{
  /** Lines on each axis, at least two; 0 if there is no block. */
  std::array<Id, 3> Sizes{ 0, 0, 0 };
  /** The point at each crossing of lines, the first axis first. */
  std::vector<Id> Points;

  bool IsEmpty() const { return this->Points.empty(); }
};

/** Points are distinct and finite. */
GridBlock FindGridBlock(const RawVector<Vec3>& points);

/** How many tetrahedra MeshGridBlock() makes, those at infinity included. */
std::size_t GetNumberOfTetrahedra(const GridBlock& block);

/**
 * Fills the first GetNumberOfTetrahedra() entries of tetrahedra and neighbors, which are as in
 * DelaunayTetrahedralization. The number of points is the vertex at infinity, which comes first in
 * its tetrahedra. False if aborted.
 */
bool MeshGridBlock(const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads,
  const ExecutionContext& context, RawVector<TetrahedronIds>& tetrahedra,
  RawVector<TetrahedronIds>& neighbors);
} // namespace cdm

#endif
