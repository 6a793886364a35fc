// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/BorderPeeling.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cdm
{
namespace
{
/** Degrees: what two facets on a boundary bend at most if they are to be exchanged. */
constexpr double LargestPeelBend = 1.0;

/** Number of the edge, in the order of GetDihedralAngles(), between two vertices. */
int GetEdge(int first, int second)
{
  const int low = std::min(first, second);
  return low + std::max(first, second) - (low == 0 ? 1 : 0);
}
} // namespace

/**
 * Whether the tetrahedron is flat and has exactly two facets on the border of its region, both to
 * the same one. These meet in the outer edge, the other two facets in the inner edge.
 */
bool BorderPeeling::FindPeeledEdges(
  Id tetrahedron, int& outerEdge, int& innerEdge, Id& neighborRegion) const
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  std::array<int, 4> facets;
  int front = 0;
  int back = 4;
  for (int facet = 0; facet < 4; ++facet)
  {
    const Id neighbor = mesh.Neighbors[tetrahedron][facet];
    const Id region = neighbor == NoId ? OutsideRegion : mesh.Regions[neighbor / 4];
    if (neighbor != NoId && region == mesh.Regions[tetrahedron])
    {
      facets[--back] = facet;
      continue;
    }
    if (front > 0 && region != neighborRegion)
    {
      return false;
    }
    neighborRegion = region;
    facets[front++] = facet;
  }
  if (front != 2)
  {
    return false;
  }
  const TetrahedronIds& ids = mesh.Tetrahedra[tetrahedron];
  const std::array<Vec3, 4> points{ this->Mesh.GetPoint(ids[0]), this->Mesh.GetPoint(ids[1]),
    this->Mesh.GetPoint(ids[2]), this->Mesh.GetPoint(ids[3]) };
  if (GetSmallestHeight(points[0], points[1], points[2], points[3]) >= this->Flatness)
  {
    return false;
  }
  // The vertices opposite to the border's facets are those of the inner edge.
  innerEdge = GetEdge(facets[0], facets[1]);
  outerEdge = GetEdge(facets[2], facets[3]);
  const std::array<double, 6> angles =
    GetDihedralAngles(points[0], points[1], points[2], points[3]);
  return angles[innerEdge] >= 180.0 - LargestPeelBend &&
    angles[outerEdge] >= 180.0 - LargestPeelBend;
}

bool BorderPeeling::IsOnlyTetrahedronAtEdge(Id tetrahedron, int edge)
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  if (!this->Incidence)
  {
    this->Incidence.emplace(mesh, 1);
  }
  const TetrahedronIds& ids = mesh.Tetrahedra[tetrahedron];
  const Id end = ids[EdgeVertices[edge][1]];
  bool isOnly = true;
  this->Incidence->ForEachTetrahedron(ids[EdgeVertices[edge][0]],
    [&](Id other, int)
    {
      isOnly = isOnly &&
        (other == tetrahedron || this->Mesh.IsDead(other) ||
          !Contains(mesh.Tetrahedra[other], end));
    });
  return isOnly;
}

bool BorderPeeling::PeelOff(Id tetrahedron)
{
  int outerEdge = 0;
  int innerEdge = 0;
  Id neighborRegion = NoId;
  EdgeRing ring;
  if (!this->FindPeeledEdges(tetrahedron, outerEdge, innerEdge, neighborRegion) ||
    neighborRegion != OutsideRegion ||
    !this->Mesh.FindRing(tetrahedron, innerEdge, this->Mesh.GetMesh().Tetrahedra.size(), ring) ||
    !this->Mesh.IsInOneRegion(ring) || !this->IsOnlyTetrahedronAtEdge(tetrahedron, outerEdge))
  {
    return false;
  }
  this->Mesh.Remove(tetrahedron);
  return true;
}

bool BorderPeeling::HandOver(Id tetrahedron)
{
  TetMesh& mesh = this->Mesh.GetMesh();
  int outerEdge = 0;
  int innerEdge = 0;
  Id neighborRegion = NoId;
  EdgeRing ring;
  if (!this->FindPeeledEdges(tetrahedron, outerEdge, innerEdge, neighborRegion) ||
    neighborRegion == OutsideRegion ||
    !this->Mesh.FindRing(tetrahedron, innerEdge, mesh.Tetrahedra.size(), ring) ||
    !this->Mesh.IsInOneRegion(ring))
  {
    return false;
  }
  const Id ownRegion = std::exchange(mesh.Regions[tetrahedron], neighborRegion);
  Flip flip;
  this->Flips.TryEdge(tetrahedron, outerEdge, flip);
  if (flip.New.empty())
  {
    mesh.Regions[tetrahedron] = ownRegion;
    return false;
  }
  this->Mesh.Apply(flip);
  return true;
}
} // namespace cdm
