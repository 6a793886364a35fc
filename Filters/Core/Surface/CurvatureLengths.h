// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvatureLengths.h
 * @brief How long edges may be so that triangles stay near a curved surface.
 *
 * An equilateral triangle with its corners on a sphere of radius R stays within e of it if its edges
 * are no longer than sqrt(6 e R - 3 e^2). Longer ones can be as near on a rough surface, but make
 * folds and narrow triangles.
 *
 * Method: a radius is that of the secants around a point: of the normals of points at half a reach
 * to a whole one, how far they are apart for the distance; one in ten may be nearer. It stands for
 * all points within a quarter of the reach. A radius below e counts as e: what is so small can go.
 *
 * Points on chains have no length of their own: infinity, like points of flat parts.
 * Guarantees: deterministic; does not depend on scale and position but for rounding.
 * Cost: some twenty searches per square of the reach, each of the points within a reach.
 * References: M. Dunyach, D. Vanderhaeghe, L. Barthe, M. Botsch, "Adaptive remeshing for real-time
 * mesh deformation", 2013, doi:10.2312/conf/EG2013/short/029-032 (the length).
 */
#ifndef cdmCurvatureLengths_h
#define cdmCurvatureLengths_h

#include "Core/Meshes/TriangleMesh.h"
#include "Core/Surface/StructuralEdges.h"

#include <vector>

namespace cdm
{
/**
 * @param chains edges that bound the facets
 * @param reaches one for each point: how far away normals are compared; model units
 * @param deviation the e of above; model units, > 0
 * @return a length for each point
 */
std::vector<double> GetCurvatureLengths(const TriangleMesh& surface,
  const std::vector<StructuralEdge>& chains, const std::vector<double>& reaches, double deviation);
} // namespace cdm

#endif
