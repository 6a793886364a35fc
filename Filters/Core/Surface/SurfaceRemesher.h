// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceRemesher.h
 * @brief Makes the triangles of a surface as large as wanted and even, within a bound of the
 *   distance from the original.
 *
 * Method:
 *  1. structural edges (StructuralEdges.h), with a feature angle; short sharp edges that end inside
 *     of a facet are none. They are the chains, which stay, and between them are the facets; the
 *     corners where chains meet or turn sharply stay where they are, and so do points where parts
 *     of the surface touch;
 *  2. a surface of strips (below) has its short edges collapsed first, and what is left is cut to 2^k
 *     times the wanted length, 2^(k-1) times and so on: else strips would be cut into pieces as
 *     narrow as they are, which collapse one by one;
 *  3. rounds of: edges longer than 4/3 of the wanted length are split, longest first; edges shorter
 *     than 4/5 of it collapse, shortest first; edges are flipped where the smallest angle of the
 *     two triangles grows; points move towards the centers of gravity of their triangles, along
 *     chains to the middle between their neighbors, and from there to the nearest point of their
 *     original facet or chain;
 *  4. each of these changes is done only if the surface stays what it is (ChangeableSurface.h).
 * Where the bound does not allow it, edges stay shorter than wanted.
 *
 * A strip is a triangle that has an edge which would collapse, and one which would be split. A
 * surface of strips has at least as many of them as of others: walls of holes, fillets and bent
 * plates as CAD programs write them.
 *
 * Inputs: the invariants of TriangleMesh.h. Guarantees: these invariants are kept, and so are
 * topology, orientation, labels, and the positions of corners; each facet and each chain lies
 * within the bound of its original, and its original within the bound of it (proven, but for
 * rounding); triangles take their labels and source cell from one of the same facet. Deterministic,
 * the same for any number of threads; does not depend on scale and position but for rounding.
 * Failure: InvalidOption for a length or bound that is not positive; as of ExtractStructuralEdges.
 * The output is then empty, as after an abort.
 * Cost: O(n log n) for surfaces that get coarser; about a millisecond for a removed point. Threads
 * share what it takes to prove one change, which is half of all.
 * References: M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004,
 * doi:10.1145/1057432.1057457 (the operations, their order and thresholds); T. K. Dey,
 * H. Edelsbrunner, S. Guha, D. V. Nekhayev, "Topology preserving edge contraction", 1999 (the link
 * condition for surfaces that are no manifolds).
 */
#ifndef cdmSurfaceRemesher_h
#define cdmSurfaceRemesher_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TriangleMesh.h"
#include "Core/Sizing/SizingField.h"

#include <vector>

namespace cdm
{
/** Edges shorter than this part of the wanted length collapse. */
constexpr double CollapseRatio = 4.0 / 5.0;
/** Edges longer than this part of the wanted length are split. */
constexpr double SplitRatio = 4.0 / 3.0;

/** Whether at least half of the triangles are strips. lengths: wanted ones, at each point. */
bool IsOfStrips(const TriangleMesh& surface, const std::vector<double>& lengths);

struct SurfaceRemesherOptions
{
  /** What edges are to be like, without a sizing field. Model units, > 0. */
  double EdgeLength = 0.0;
  /** Largest distance of each surface from the other one. Model units, > 0. */
  double MaximumDeviation = 0.0;
  /** Edges that bend by more stay. Degrees, 0 to 180. */
  double FeatureAngle = 40.0;
};

struct SurfaceRemesherInput
{
  const TriangleMesh* Surface = nullptr;
  /** Empty, or a number for each triangle: edges between different ones stay. */
  std::vector<Id> Facets = {};
  /** What edges are to be like; its largest length counts. May be empty. */
  SizingField Sizing = {};
};

struct SurfaceRemesherOutput
{
  /** SourceCells: triangle of the input surface. */
  TriangleMesh Surface;
  /** For each of the first points of Surface the point of the input whose position it has. */
  std::vector<Id> PointSources;
  /** For each of the other points of Surface: parents, as ids of points of the input. */
  std::vector<PointParents> NewPoints;
};

Status RemeshSurface(const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options,
  const ExecutionContext& context, SurfaceRemesherOutput& output);
} // namespace cdm

#endif
