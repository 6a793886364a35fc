// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SteinerPointChecks.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Meshes/MeshInvariants.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace cdm
{
namespace
{
Status CheckMesh(const SteinerPointRefinerInput& input, int threads)
{
  const TetMesh& mesh = *input.Mesh;
  Status status = CheckMeshInvariants(mesh, threads);
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<Id> outside;
  for (Id t = 0; t < static_cast<Id>(mesh.Regions.size()); ++t)
  {
    if (mesh.Regions[t] < 0)
    {
      outside.push_back(t);
    }
  }
  if (!outside.empty())
  {
    return Status::InvalidInput(std::to_string(outside.size()) +
        " tetrahedra have a negative region id, which stands for the outside; number the regions "
        "from 0 on.",
      outside);
  }
  std::vector<Id> wrong;
  for (Id p = 0; p < static_cast<Id>(input.NewPoints.size()); ++p)
  {
    if (!IsFinite(input.NewPoints[p]))
    {
      wrong.push_back(p);
    }
  }
  return wrong.empty() ? Status()
                       : Status::InvalidInput(std::to_string(wrong.size()) +
                             " points to be inserted have coordinates that are not finite.",
                           {}, wrong);
}

/** The triangles given have to be all facets between regions, and besides them only facets. */
Status CheckBoundary(const SteinerPointRefinerInput& input)
{
  const TetMesh& mesh = *input.Mesh;
  const TriangleMesh& boundary = *input.Boundary;
  const Status status = CheckMeshInput(mesh, &boundary);
  if (!status.IsOk())
  {
    return status;
  }
  if (boundary.Labels.empty() || boundary.Points != mesh.Points)
  {
    return Status::InvalidInput("The boundary needs the points of the mesh, in the same order, and "
                                "labels: use the one that belongs to it.");
  }
  std::vector<std::pair<TriangleIds, Id>> facets;
  for (Id t = 0; t < static_cast<Id>(boundary.Triangles.size()); ++t)
  {
    facets.emplace_back(Sorted(boundary.Triangles[t]), t);
  }
  std::sort(facets.begin(), facets.end());
  const auto find = [&](const TriangleIds& ids)
  {
    const auto found =
      std::lower_bound(facets.begin(), facets.end(), std::pair<TriangleIds, Id>(Sorted(ids), NoId));
    return found != facets.end() && found->first == Sorted(ids) ? found->second : NoId;
  };
  std::vector<char> isFacet(boundary.Triangles.size(), 0);
  std::size_t missing = 0;
  for (Id t = 0; t < static_cast<Id>(mesh.Tetrahedra.size()); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      const Id neighbor = mesh.Neighbors[t][i];
      const bool isInner = neighbor != NoId && mesh.Regions[neighbor / 4] == mesh.Regions[t];
      if (isInner && neighbor / 4 < t)
      {
        continue;
      }
      const Id triangle = find(GetFacet(mesh.Tetrahedra[t], i));
      if (triangle != NoId)
      {
        isFacet[triangle] = 1;
      }
      else if (!isInner)
      {
        ++missing;
      }
    }
  }
  if (missing > 0)
  {
    return Status::InvalidInput(std::to_string(missing) +
      " facets between regions or at the outside are not among the triangles of the boundary: use "
      "the one that belongs to the mesh, or none.");
  }
  std::vector<Id> cells;
  for (std::size_t t = 0; t < isFacet.size(); ++t)
  {
    if (!isFacet[t])
    {
      cells.push_back(static_cast<Id>(t));
    }
  }
  return cells.empty()
    ? Status()
    : Status::InvalidInput(std::to_string(cells.size()) +
          " triangles of the boundary are no facets of the mesh: use the one that "
          "belongs to it, or none.",
        cells);
}
} // namespace

Status CheckSteinerPointInput(const SteinerPointRefinerInput& input, int threads)
{
  const Status status = CheckMesh(input, threads);
  return status.IsOk() && input.Boundary != nullptr ? CheckBoundary(input) : status;
}
} // namespace cdm
