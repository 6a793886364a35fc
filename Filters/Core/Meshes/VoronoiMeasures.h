// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VoronoiMeasures.h
 * @brief Shares of a tetrahedron and a triangle in the Voronoi boxes of their points, signed.
 *
 * The circumcenters of a tetrahedron and of its facets, and the midpoints of its edges, cut it into
 * the parts of its four vertices. Where a circumcenter lies beyond a facet, parts have negative
 * volumes; summed over a Delaunay mesh they cancel, and the sums are the Voronoi boxes. The shares
 * of one tetrahedron always sum up to its volume.
 *
 * With l the length of edge ab, h the distance of the circumcenter of a facet from the edge, and g
 * that of the tetrahedron from the facet, the area of the Voronoi facet of ab within the
 * tetrahedron is the sum of h g / 2 over both facets at ab; h = l cot(gamma) / 2 with the facet's
 * angle gamma opposite to ab. So area / l is a rational function of the coordinates: it is
 * evaluated with twice the digits of double, as single terms can be many times larger than their
 * sum.
 */
#ifndef cdmVoronoiMeasures_h
#define cdmVoronoiMeasures_h

#include "Core/Basics/Vec3.h"
#include "Core/Geometry/DoubleDouble.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/TetMesh.h"

#include <array>
#include <cmath>
#include <vector>

namespace cdm
{
/**
 * Area of the Voronoi facet of an edge over the length of the edge, for the edges ab, ac, ad, bc,
 * bd, cd (as in TetrahedronEdges). The tetrahedron must not be flat.
 */
std::array<DoubleDouble, 6> GetCouplings(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/**
 * Bound, to first order, of how much rounding of the coordinates can change the coupling of an edge
 * in a region: the sum over the records of the edge. It grows with the distance from the origin and
 * with obtuse angles. Inverted and flat tetrahedra have no part in it.
 */
double GetCouplingRounding(const TetMesh& mesh,
  std::vector<SimplexIncidence::Record>::const_iterator begin,
  std::vector<SimplexIncidence::Record>::const_iterator end, Id region);

/** The sum of the couplings of an edge over the tetrahedra of a region. */
class CouplingSum
{
public:
  void Add(const DoubleDouble& coupling)
  {
    this->Sum = this->Sum + coupling;
    this->Lengths += std::abs(coupling.High);
  }
  double Get() const { return this->Sum.High; }
  /**
   * Negative by more than 1e-12 of the lengths involved, that of the edge among them, and by more
   * than rounding: what rounded coordinates leave of a coupling that is zero does not count.
   * @param getRounding GetCouplingRounding(); asked for in case of need
   */
  template <typename GetRounding>
  bool IsNegative(double edgeLength, const GetRounding& getRounding) const
  {
    return this->Sum.High < -1e-12 * (edgeLength + this->Lengths) &&
      this->Sum.High < -getRounding();
  }

private:
  DoubleDouble Sum;
  double Lengths = 0.0;
};

/**
 * Whether the coupling of an edge, of which all records are given, is negative in a region.
 * Inverted and flat tetrahedra have no part in it.
 */
bool HasNegativeCoupling(const TetMesh& mesh, const EdgeIds& edge,
  std::vector<SimplexIncidence::Record>::const_iterator begin,
  std::vector<SimplexIncidence::Record>::const_iterator end, Id region);

/**
 * Volume of the parts of a tetrahedron in the boxes of its vertices, each of the 24 pieces between an
 * edge, a facet and the circumcenters counted without its sign: what solvers add up that do not know
 * the signs. It is the volume of the tetrahedron where no circumcenter, of it or of a facet, lies
 * outside, and larger otherwise. The tetrahedron must not be flat. Ten digits are right.
 */
double GetUnsignedBoxVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/** Circumcenter, its coordinates rounded once; the tetrahedron must not be flat. */
Vec3 GetAccurateCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/** Parts of the area of a triangle that are nearest to a, b and c. It must not be degenerate. */
std::array<DoubleDouble, 3> GetVertexAreas(const Vec3& a, const Vec3& b, const Vec3& c);

/**
 * Length of the opposite edge times the cotangent of the dihedral angle there, for each edge (Crit.
 * 3.3): minus six times the share in the entry of the stiffness matrix. Positive orientation.
 */
std::array<DoubleDouble, 6> GetOppositeCotangents(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

DoubleDouble GetSquaredDistance(const Vec3& a, const Vec3& b);
} // namespace cdm

#endif
