// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlatTetrahedra.h
 * @brief How many tetrahedra of a mesh are flat, and what makes them so.
 *
 * A tetrahedron with a small dihedral angle is
 *  1. at a sharp angle of the input, if at one of its vertices its region is a wedge of less than 60
 *     degrees along a structural edge, or two structural edges meet at less than 30 degrees; or if one
 *     vertex lies on one side of such a wedge or angle, and another one on the other side;
 *  2. otherwise across a layer, if all its points lie on outer or interface facets: the layer is one
 *     tetrahedron thick there;
 *  3. otherwise flat for another reason: better ones could be made, unless edges at which the boundary
 *     bends by less than a degree, which are not structural here, are in the way.
 * The angle of a wedge is the sum of the dihedral angles of the region's tetrahedra around the edge.
 * (If the region has several wedges at the edge, their sum counts.) A side of a wedge is a surface
 * facet: outer and interface facets that go straight on from one another. A side of an angle is a
 * structural edge with those that go straight on from it.
 *
 * Cost: O(n) for n tetrahedra if none is flat, otherwise O(n log n).
 */
#ifndef cdmFlatTetrahedra_h
#define cdmFlatTetrahedra_h

#include "Core/Certificate/BasicChecks.h"
#include "Core/Certificate/MeshCertificate.h"

#include <vector>

namespace cdm
{
/** Fills Under5Degrees to Under15Degrees. Smallest dihedral angles of all tetrahedra, in degrees. */
void CountFlatTetrahedra(const TetMesh& mesh, const std::vector<double>& smallestAngles,
  const BasicFindings& findings, MeshCertificate& certificate);
} // namespace cdm

#endif
