// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BasicChecks.h
 * @brief Steps 1 to 4 of the certificate, see MeshCertificate.h.
 */
#ifndef cdmBasicChecks_h
#define cdmBasicChecks_h

#include "Core/Certificate/MeshCertificate.h"
#include "Core/Certificate/SphereCriteria.h"

#include <algorithm>
#include <utility>
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

/** A facet of a tetrahedron, or a triangle of the boundary, found by its sorted points. */
struct FacetRecord
{
  TriangleIds Points;
  /** Facet id, or id of the triangle. */
  Id Source;
  /** Whether the normal of the sorted points is the source's. */
  bool IsEven;

  friend bool operator<(const FacetRecord& a, const FacetRecord& b)
  {
    return a.HasPointsOf(b) ? a.Source < b.Source : a.HasLowerPoints(b);
  }

  /**
   * Whether the points come first in lexicographic order. They are compared number by number:
   * comparing arrays by their own operators took half of the sort's time.
   */
  bool HasLowerPoints(const FacetRecord& other) const
  {
    for (int i = 0; i < 2; ++i)
    {
      if (this->Points[i] != other.Points[i])
      {
        return this->Points[i] < other.Points[i];
      }
    }
    return this->Points[2] < other.Points[2];
  }

  bool HasPointsOf(const FacetRecord& other) const
  {
    return this->Points[0] == other.Points[0] && this->Points[1] == other.Points[1] &&
      this->Points[2] == other.Points[2];
  }
};

/** The end of the records with the same points as the first one. */
template <typename Iterator>
Iterator FindEndOfGroup(Iterator begin, Iterator end)
{
  return std::find_if(
    begin, end, [&](const FacetRecord& other) { return !other.HasPointsOf(*begin); });
}

/** The findings that the later steps need. */
struct BasicFindings
{
  /** Exact orientation of each tetrahedron. */
  std::vector<signed char> Orientations;
  /** Crit. 5.3; a flat tetrahedron, which has no sphere, counts as Delaunay. */
  std::vector<char> IsDelaunay;
  /** Whether the sphere of a tetrahedron proves that its facets and edges are Delaunay, too. */
  bool IsProof(Id tetrahedron) const
  {
    return this->Orientations[tetrahedron] != 0 && this->IsDelaunay[tetrahedron] != 0;
  }
  Id NumberOfFacets = 0;
  /**
   * Facets of tetrahedra that need to be looked at, ascending: those that are triangles of the
   * boundary, and all others but those between two tetrahedra of one region, at least one of which
   * is Delaunay and not flat, that know each other.
   */
  std::vector<FacetRecord> Facets;
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
  /** Numbers of a structural edge and of a border facet that has it, ascending. */
  std::vector<std::pair<Id, Id>> StructuralEdgeFacets;
  /** Two border facets that go straight on across their common edge. */
  std::vector<std::pair<Id, Id>> SmoothFacets;
};

/** The criteria are those of the mesh's points. Input has been checked by CheckMeshInput(). */
Status CheckBasics(const TetMesh& mesh, const TriangleMesh* boundary,
  const SphereCriteria& criteria, const CertificateOptions& options,
  const ExecutionContext& context, MeshCertificate& certificate, BasicFindings& findings);
} // namespace cdm

#endif
