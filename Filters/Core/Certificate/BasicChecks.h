// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BasicChecks.h
 * @brief Steps 1 to 4 of the certificate, see MeshCertificate.h.
 */
#ifndef cdmBasicChecks_h
#define cdmBasicChecks_h

#include "Core/Certificate/MeshCertificate.h"
#include "Core/Certificate/SphereCriteria.h"

#include <vector>

namespace cdm
{
/** An outer or interface facet. */
struct BorderFacet
{
  /** Ascending. */
  TriangleIds Points;
  /** Regions of its two sides, ascending. */
  RegionPair Regions;
};

/** The findings that the later steps need. */
struct BasicFindings
{
  /** Exact orientation of each tetrahedron. */
  std::vector<signed char> Orientations;
  /** Crit. 5.3; a flat tetrahedron, which has no sphere, counts as Delaunay. */
  std::vector<char> IsDelaunay;
  /** Ascending by points, and whether Crit. 3.1 holds. */
  std::vector<BorderFacet> BorderFacets;
  std::vector<char> HasEmptyFacetSphere;
  /** Edges of these facets, ascending. */
  std::vector<EdgeIds> BorderEdges;
  /**
   * Border edges where the facets do not go straight on, ascending; and whether Crit. 3.2 holds
   * there.
   */
  std::vector<EdgeIds> StructuralEdges;
  std::vector<char> HasEmptySphere;
};

/** The criteria are those of the mesh's points. Input has been checked by CheckMeshInput(). */
Status CheckBasics(const TetMesh& mesh, const TriangleMesh* boundary,
  const SphereCriteria& criteria, const CertificateOptions& options,
  const ExecutionContext& context, MeshCertificate& certificate, BasicFindings& findings);
} // namespace cdm

#endif
