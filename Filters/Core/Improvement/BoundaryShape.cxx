// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundaryShape.h"

#include <utility>

namespace cdm
{
BoundaryShape::BoundaryShape(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
  const std::vector<StructuralEdge>& keptEdges, double sharpPlaneAngle)
  : Spheres(surface, keptEdges),
    PointTriangles(ListTrianglesAtPoints(surface.Triangles, surface.Points.size())),
    Sharp(surface, edges, this->PointTriangles, sharpPlaneAngle),
    Layers(surface, this->PointTriangles)
{
}

BoundaryShape::BoundaryShape(BoundaryShape&& coarse, const TriangleMesh& surface,
  const std::vector<StructuralEdge>& edges, const std::vector<StructuralEdge>& keptEdges,
  const std::vector<Id>& parents)
  : Spheres(surface, keptEdges),
    PointTriangles(ListTrianglesAtPoints(surface.Triangles, surface.Points.size())),
    Sharp(std::move(coarse.Sharp), edges, this->PointTriangles, parents),
    Layers(coarse.Layers, this->PointTriangles, parents)
{
}
} // namespace cdm
