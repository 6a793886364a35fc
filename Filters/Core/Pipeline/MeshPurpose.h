// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPurpose.h
 * @brief What a mesh is for, and what that means for the options that are not given.
 *
 * A purpose decides the options of MeshOptionChoices, each by itself, as long as it is not given:
 *
 * | option              | finite volumes  | finite elements | fewest points |
 * |---------------------|-----------------|-----------------|---------------|
 * | Criterion           | smallest sphere | Delaunay        | Delaunay      |
 * | AddsSteinerPoints   | yes             | yes             | no            |
 * | RemovesSlivers      | yes             | yes             | yes           |
 * | DihedralAngleTarget | 15              | 20              | 15            |
 * | RadiusEdgeRatio     | 1.4             | 1.4             | 1.4           |
 * | MaximumEdgeLength   | DefaultSize.h   | DefaultSize.h   | 0: off        |
 * | GeneratesMeshPoints | with a size     | with a size     | no            |
 *
 * MaximumEdgeLength is off if there is a sizing, unless it is given: the sizing says how large edges
 * are. Mesh points are generated where Steiner points would come to be for the size alone: with a
 * lattice the mesh has up to half of the tetrahedra.
 *
 * Finite volumes: with Steiner points and criterion 3.1 no coupling of the box method is negative:
 * circumcenters lie in their regions (Fig. 3.4), and structural edges with a negative coupling are
 * split. Criterion 3.2, which asks for empty spheres of all structural edges, is not needed for
 * that. Finite elements: shapes count. Fewest points: the points of the input, and those without
 * which its surface is not part of a Delaunay mesh.
 */
#ifndef cdmMeshPurpose_h
#define cdmMeshPurpose_h

#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <optional>
#include <string>

namespace cdm
{
enum class MeshPurpose
{
  FiniteVolumes = 0,
  FiniteElements = 1,
  FewestPoints = 2
};
constexpr int NumberOfMeshPurposes = 3;

/** The options that a purpose decides, with their values. */
struct MeshSettings
{
  SurfaceCriterion Criterion = SurfaceCriterion::Delaunay;
  bool AddsSteinerPoints = false;
  bool RemovesSlivers = true;
  /** Degrees. */
  double DihedralAngleTarget = 15.0;
  double RadiusEdgeRatio = 1.4;
  /** Model units; 0: off. */
  double MaximumEdgeLength = 0.0;
  bool GeneratesMeshPoints = false;
};

/** The same options: those given, and those for the purpose to decide. */
struct MeshOptionChoices
{
  /** What every triangle of the boundary has to fulfil. */
  std::optional<SurfaceCriterion> Criterion;
  std::optional<bool> AddsSteinerPoints;
  /** Whether tetrahedra with a dihedral angle below the target are to be removed. */
  std::optional<bool> RemovesSlivers;
  /** Degrees, 0 to 70; with Steiner points more than 40 count as 40. */
  std::optional<double> DihedralAngleTarget;
  /** Circumradius to shortest edge, with Steiner points. 0 (off) or at least 1. */
  std::optional<double> RadiusEdgeRatio;
  /** Edges of the surface, with Steiner points all edges. Model units, 0 (off) or above. */
  std::optional<double> MaximumEdgeLength;
  /** Whether points are placed inside of the regions before there are tetrahedra. */
  std::optional<bool> GeneratesMeshPoints;
};

/**
 * The values of all options. MaximumEdgeLength is 0 where the purpose asks for a default size:
 * NeedsDefaultSize() says so. GeneratesMeshPoints, if not given, holds for sizes only.
 */
MeshSettings MakeSettings(MeshPurpose purpose, const MeshOptionChoices& given);

/** Whether the maximum edge length is not given, and the purpose wants one. */
bool NeedsDefaultSize(MeshPurpose purpose, const MeshOptionChoices& given, bool hasSizing);

/** "finite volumes". */
const char* GetPurposeName(MeshPurpose purpose);

/**
 * A line: what the mesh is for and how it was made; options that were not given are in brackets,
 * as in "Mesh for finite volumes: [criterion smallest sphere, ...], maximum edge length 0.1".
 */
std::string DescribeSettings(
  MeshPurpose purpose, const MeshOptionChoices& given, const MeshSettings& settings);
} // namespace cdm

#endif
