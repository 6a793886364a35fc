// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartSimplices.h"

#include "Core/Basics/RawVector.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Search/SpatialSort.h"

#include <algorithm>
#include <numeric>

namespace cdm
{
namespace
{
/** The chosen points are ascending by number. Numbers: that of each vertex among them. */
Status Tetrahedralize(const PartPoints& points, const std::vector<Id>& chosen,
  const ExecutionContext& context, std::vector<Id>& numbers, DelaunayTetrahedralization& all)
{
  const int numberOfThreads = context.GetNumberOfThreads();
  std::vector<Vec3> positions;
  positions.reserve(chosen.size());
  for (Id point : chosen)
  {
    positions.push_back(points[point].Position);
  }
  numbers.resize(chosen.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  SortAlongHilbertCurve(positions, numbers, numberOfThreads);
  RawVector<Vec3> vertices;
  vertices.reserve(chosen.size());
  for (Id number : numbers)
  {
    vertices.push_back(positions[number]);
  }
  return BuildDelaunayTetrahedralization(
    vertices, numbers, FindGridBlock(vertices), numberOfThreads, context, all);
}
} // namespace

Status VisitPartSimplices(const PartPoints& points, std::vector<Id> chosen,
  const ExecutionContext& context, const std::function<bool(const PartSimplex&)>& visit)
{
  std::sort(chosen.begin(), chosen.end(),
    [&points](Id a, Id b) { return points[a].Number < points[b].Number; });
  std::vector<Id> numbers;
  DelaunayTetrahedralization all;
  Status status = Tetrahedralize(points, chosen, context.Part(0.0, 0.8), numbers, all);
  if (!status.IsOk())
  {
    return status;
  }
  const Id infinite = static_cast<Id>(chosen.size());
  const auto toPoints = [&](const TetrahedronIds& ids)
  {
    TetrahedronIds result;
    std::transform(ids.begin(), ids.end(), result.begin(),
      [&](Id vertex) { return vertex == infinite ? NoId : chosen[numbers[vertex]]; });
    return result;
  };
  const ExecutionContext part = context.Part(0.8, 1.0);
  bool isGoingOn = true;
  for (std::size_t t = 0; t < all.Tetrahedra.size() && isGoingOn; ++t)
  {
    if (t % PartReportInterval == 0 &&
      !part.Continue(double(t) / double(all.Tetrahedra.size()), PartActivity))
    {
      return Status::Aborted();
    }
    if (all.Tetrahedra[t][0] == NoId)
    {
      continue;
    }
    PartSimplex simplex{ toPoints(all.Tetrahedra[t]), false };
    const auto found = std::find(simplex.Ids.begin(), simplex.Ids.end(), NoId);
    if (found != simplex.Ids.end())
    {
      const Id inner = all.Neighbors[t][found - simplex.Ids.begin()];
      const TetrahedronIds ids = toPoints(all.Tetrahedra[inner / 4]);
      const TriangleIds facet = GetFacet(ids, static_cast<int>(inner % 4));
      simplex = { { facet[0], facet[1], facet[2], ids[inner % 4] }, true };
    }
    isGoingOn = visit(simplex);
  }
  return status;
}
} // namespace cdm
