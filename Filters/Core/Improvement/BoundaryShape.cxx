// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BoundaryShape.h"

namespace cdm
{
BoundaryShape::BoundaryShape(const TriangleMesh& surface, const std::vector<StructuralEdge>& edges,
  const std::vector<StructuralEdge>& keptEdges, double sharpPlaneAngle, double layerAspectRatio)
  : Spheres(surface, keptEdges),
    PointTriangles(ListTrianglesAtPoints(surface.Triangles, surface.Points.size())),
    Sharp(surface, edges, this->PointTriangles, sharpPlaneAngle),
    Layers(surface, this->PointTriangles, layerAspectRatio), Surface(surface), Edges(edges)
{
}

void BoundaryShape::Follow(const BoundaryChange& change)
{
  this->Spheres.Follow(change.Triangles, change.Edges, change.Segments);
  this->PointTriangles.Build(static_cast<Id>(this->Surface.Points.size()), this->Surface.Triangles);
  this->Sharp.Follow(this->Edges, change.Edges, change.Triangles, change.Parents);
  this->Layers.Follow(change.Triangles, change.Parents);
}
} // namespace cdm
