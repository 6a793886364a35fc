// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/TetrahedronWalk.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Search/SpatialSort.h"

#include <cmath>
#include <numeric>

namespace cdm
{
namespace
{
/** Positions whose walks follow each other. */
constexpr std::size_t PositionsOfWalk = 1 << 12;

class Walk
{
public:
  explicit Walk(const TetMesh& mesh)
    : Mesh(mesh), MaximumSteps(100 + 10 * std::lround(std::cbrt(mesh.Tetrahedra.size())))
  {
  }

  /** Goes on to a position; NoId if it does not arrive. */
  Id Find(const Vec3& position)
  {
    for (long step = 0; step < this->MaximumSteps; ++step)
    {
      bool isHeld = true;
      Id next = NoId;
      for (int i = 0; i < 4 && next == NoId; ++i)
      {
        const TriangleIds facet = GetFacet(this->Mesh.Tetrahedra[this->Current], i);
        if (Orientation(this->Mesh.Points[facet[0]], this->Mesh.Points[facet[1]],
              this->Mesh.Points[facet[2]], position) > 0)
        {
          isHeld = false;
          next = this->Mesh.Neighbors[this->Current][i];
        }
      }
      if (isHeld)
      {
        return this->Current;
      }
      if (next == NoId)
      {
        return NoId;
      }
      this->Current = next / 4;
    }
    return NoId;
  }

private:
  const TetMesh& Mesh;
  const long MaximumSteps;
  Id Current = 0;
};
} // namespace

std::vector<Id> FindTetrahedra(
  const TetMesh& mesh, const std::vector<Vec3>& positions, int numberOfThreads)
{
  std::vector<Id> found(positions.size(), NoId);
  if (mesh.Tetrahedra.empty())
  {
    return found;
  }
  std::vector<Id> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  SortAlongHilbertCurve(positions, order, numberOfThreads);
  ParallelLoop(order.size(), { numberOfThreads, PositionsOfWalk }, {}, "",
    [&](std::size_t begin, std::size_t end, std::size_t)
    {
      Walk walk(mesh);
      for (std::size_t i = begin; i < end; ++i)
      {
        found[order[i]] = walk.Find(positions[order[i]]);
      }
    });
  return found;
}
} // namespace cdm
