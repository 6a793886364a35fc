// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ControlVolumes.h
 * @brief Control volumes for the box method: Voronoi boxes clipped to regions, and their couplings.
 *
 * Method (thesis 3.2.1):
 *  1. for each tetrahedron and each of its edges the signed area of the Voronoi facet within
 *     (VoronoiMeasures.h);
 *  2. their sums for each (edge, region): the coupling areas;
 *  3. the box of a (point, region) is the union of the pyramids from the point over its Voronoi
 *     facets: volume l A / 6 for each edge of length l and coupling area A;
 *  4. for each outer or interface facet the parts of its area that are nearest to its vertices: the
 *     boundary areas of (point, pair of regions);
 *
 * Guarantees: the boxes of a region sum up to its volume to rounding, its boundary areas to the
 * area of its boundary, on every mesh; areas are signed, so that this holds where couplings are
 * negative too (those are counted). Deterministic for any number of threads.
 * Failure: InvalidInput names tetrahedra that are inverted or flat.
 * Cost: O(n log n); 160 bytes per tetrahedron.
 * References: P. Fleischmann, thesis, 3.2.1; R. H. Macneal, "An asymmetrical finite difference
 * network", 1953, doi:10.1090/qam/99978 (couplings).
 */
#ifndef cdmControlVolumes_h
#define cdmControlVolumes_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/Meshes/TetMesh.h"

namespace cdm
{
/** The part of a region that is nearest to a point of it. */
struct ControlBox
{
  Id Point = NoId;
  Id Region = NoId;
  double Volume = 0.0;
};

struct EdgeCoupling
{
  /** Ascending. */
  EdgeIds Points{ NoId, NoId };
  Id Region = NoId;
  /** Signed area of the Voronoi facet within the region. */
  double Area = 0.0;
  double Length = 0.0;
};

struct BoundaryArea
{
  Id Point = NoId;
  /** Ascending; OutsideRegion at the outside. */
  Id LowRegion = OutsideRegion;
  Id HighRegion = OutsideRegion;
  double Area = 0.0;
};

struct ControlVolumes
{
  /** Ascending by point, then by region. */
  std::vector<ControlBox> Boxes;
  /** Ascending by points, then by region. */
  std::vector<EdgeCoupling> Couplings;
  /** Ascending by point, then by regions. */
  std::vector<BoundaryArea> BoundaryAreas;
  /** Number of couplings that are negative by more than rounding. */
  Id NegativeCouplings = 0;
};

/** Computes boxes, couplings and boundary areas. The mesh needs its Neighbors. */
Status ComputeControlVolumes(
  const TetMesh& mesh, const ExecutionContext& context, ControlVolumes& volumes);
} // namespace cdm

#endif
