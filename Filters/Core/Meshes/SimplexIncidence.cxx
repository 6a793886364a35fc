// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/SimplexIncidence.h"

#include "Core/Basics/ThreadTeam.h"

#include <numeric>

namespace cdm
{
SimplexIncidence::SimplexIncidence(const TetMesh& mesh, int numberOfThreads)
  : Mesh(mesh), Begin(mesh.Points.size() + 1, 0), Corners(4 * mesh.Tetrahedra.size())
{
  // A thread looks at all tetrahedra, which is little beside the lists that it fills at random.
  constexpr std::size_t pointsOfThread = 1 << 14;
  const std::size_t numberOfPoints = mesh.Points.size();
  const int threads = static_cast<int>(std::min<std::size_t>(
    GetNumberOfThreads(numberOfThreads), 1 + numberOfPoints / pointsOfThread));
  const Id count = static_cast<Id>(this->Corners.size());
  const auto forEachCorner = [&](auto&& visit)
  {
    RunOnThreads(threads,
      [&](int thread)
      {
        const Id first = static_cast<Id>(numberOfPoints * thread / threads);
        const Id last = static_cast<Id>(numberOfPoints * (thread + 1) / threads);
        for (Id corner = count - 1; corner >= 0; --corner)
        {
          const Id point = mesh.Tetrahedra[corner / 4][corner % 4];
          if (point >= first && point < last)
          {
            visit(point, corner);
          }
        }
      });
  };
  forEachCorner([this](Id point, Id) { ++this->Begin[point]; });
  std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
  // From the last corner on, so that lists ascend.
  forEachCorner([this](Id point, Id corner) { this->Corners[--this->Begin[point]] = corner; });
}
} // namespace cdm
