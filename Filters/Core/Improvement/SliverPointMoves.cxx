// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverPointMoves.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Certificate/SphereCriteria.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Improvement/SliverList.h"
#include "Core/Improvement/SliverPerturbation.h"
#include "Core/Improvement/SurfacePointMoves.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Surface/StructuralEdges.h"

namespace cdm
{
namespace
{
/** Moves of boundary points are tried anew so often, with fewer points each time. */
constexpr int MaximumTries = 10;

class SliverPointMoves
{
public:
  SliverPointMoves(double target, const std::vector<char>& isFree, TetMesh& mesh, Id& movedPoints)
    : Target(target), IsFree(isFree), Mesh(mesh), MovedPoints(movedPoints)
  {
  }

  Status MoveInside(const ExecutionContext& context);
  /** Sets whether anything was moved. */
  Status MoveBoundary(const ExecutionContext& context, bool& isMoved);

private:
  /** The mesh with the points of its boundary first; boundary triangles, then the intact ones. */
  struct Parts
  {
    TetMesh Mesh;
    TriangleMesh Surface;
    StructuralEdgesOutput Structural;
    std::vector<StructuralEdge> IntactEdges;
    std::vector<InteriorPoint> Interior;
    /** Points of this->Mesh. */
    std::vector<Id> Sources;
    /** One for each point of the surface: whether all triangles at it are intact. */
    std::vector<char> IsIntact;
    SliverMemory Memory;

    template <typename Ids>
    Ids GetSources(Ids ids) const
    {
      for (Id& id : ids)
      {
        id = this->Sources[id];
      }
      return ids;
    }
  };
  Status TakeApart(const ExecutionContext& context, Parts& parts) const;
  Status KeepIntact(const ExecutionContext& context, Parts& parts) const;
  RefinedMesh MakeMesh(const ExecutionContext& context, Parts& parts) const
  {
    RefinedMeshOptions options;
    options.Threads = context.GetTeam();
    return RefinedMesh(parts.Mesh, { parts.Surface, parts.Structural.Edges, parts.IntactEdges },
      parts.Interior, parts.Memory, options);
  }
  void PutTogether(const Parts& parts, const TetMesh& moved);

  const double Target;
  const std::vector<char>& IsFree;
  TetMesh& Mesh;
  Id& MovedPoints;
};

/**
 * Leaves those triangles, and finds those edges, whose smallest spheres are empty of all points,
 * also of those without tetrahedra.
 */
Status SliverPointMoves::KeepIntact(const ExecutionContext& context, Parts& parts) const
{
  const SphereCriteria criteria(this->Mesh.Points);
  std::vector<EdgeIds> all;
  std::vector<TriangleIds> intact;
  for (const TriangleIds& ids : parts.Surface.Triangles)
  {
    if (all.size() % StepsBetweenChecks == 0 && !context.Continue(0.0, "Checking the boundary"))
    {
      return Status::Aborted();
    }
    const bool isIntact = criteria.HasEmptySmallestSphere(parts.GetSources(ids));
    if (isIntact)
    {
      intact.push_back(ids);
    }
    for (int i = 0; i < 3; ++i)
    {
      all.push_back(MakeEdge(ids[i], ids[(i + 1) % 3]));
      parts.IsIntact[ids[i]] &= isIntact ? 1 : 0;
    }
  }
  parts.Surface.Triangles = std::move(intact);
  SortUnique(all);
  for (std::size_t e = 0; e < all.size(); ++e)
  {
    if (e % StepsBetweenChecks == 0 && !context.Continue(0.5, "Checking the boundary"))
    {
      return Status::Aborted();
    }
    if (criteria.HasEmptySmallestSphere(parts.GetSources(all[e])))
    {
      parts.IntactEdges.emplace_back();
      parts.IntactEdges.back().Points = all[e];
    }
  }
  return Status();
}

Status SliverPointMoves::TakeApart(const ExecutionContext& context, Parts& parts) const
{
  parts.Surface = ExtractBoundary(this->Mesh);
  parts.Sources = RemoveUnusedPoints(parts.Surface);
  for (const Id p : FindPointsInside(this->Mesh, parts.Sources))
  {
    parts.Sources.push_back(p);
    const bool isFree = !this->IsFree.empty() && this->IsFree[p] != 0;
    parts.Interior.push_back({ this->Mesh.Points[p], 0.0, isFree, p, parts.Memory.MakeName() });
  }
  std::vector<Id> newIds(this->Mesh.Points.size(), NoId);
  parts.Mesh = this->Mesh;
  parts.Mesh.Points.clear();
  for (const Id p : parts.Sources)
  {
    newIds[p] = static_cast<Id>(parts.Mesh.Points.size());
    parts.Mesh.Points.push_back(this->Mesh.Points[p]);
  }
  for (TetrahedronIds& ids : parts.Mesh.Tetrahedra)
  {
    ids = Renumber(ids, newIds);
  }
  parts.IsIntact.assign(parts.Surface.Points.size(), 1);
  const Status status =
    ExtractStructuralEdges(parts.Surface, {}, context.Part(0.0, 0.25), parts.Structural);
  return status.IsOk() ? this->KeepIntact(context.Part(0.25, 1.0), parts) : status;
}

void SliverPointMoves::PutTogether(const Parts& parts, const TetMesh& moved)
{
  for (std::size_t i = 0; i < parts.Sources.size(); ++i)
  {
    this->Mesh.Points[parts.Sources[i]] = moved.Points[i];
  }
  this->Mesh.Tetrahedra = moved.Tetrahedra;
  this->Mesh.Regions = moved.Regions;
  this->Mesh.Neighbors = moved.Neighbors;
  RemoveDeadTetrahedra(this->Mesh);
  for (TetrahedronIds& ids : this->Mesh.Tetrahedra)
  {
    ids = { parts.Sources[ids[0]], parts.Sources[ids[1]], parts.Sources[ids[2]],
      parts.Sources[ids[3]] };
  }
}

Status SliverPointMoves::MoveInside(const ExecutionContext& context)
{
  Parts parts;
  Status status = this->TakeApart(context.Part(0.0, 0.1), parts);
  if (!status.IsOk())
  {
    return status;
  }
  RefinedMesh mesh = this->MakeMesh(context, parts);
  status =
    PerturbSlivers(this->Target, SliverMeans::Moves, SliverEffort, context.Part(0.1, 0.9), mesh);
  status = status.IsOk()
    ? PerturbSharp(this->Target, SliverMeans::Moves, context.Part(0.9, 1.0), mesh)
    : status;
  this->PutTogether(parts, mesh.GetMesh());
  this->MovedPoints += mesh.GetReport().MovedPoints;
  return status;
}

Status SliverPointMoves::MoveBoundary(const ExecutionContext& context, bool& isMoved)
{
  isMoved = false;
  Parts parts;
  const Status status = this->TakeApart(context.Part(0.0, 0.2), parts);
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<char> isFree = parts.IsIntact;
  for (int i = 0; i < MaximumTries; ++i)
  {
    if (!context.Continue(0.2 + 0.8 * i / MaximumTries, "Moving points of the boundary"))
    {
      return Status::Aborted();
    }
    RefinedMesh mesh = this->MakeMesh(context, parts);
    const std::vector<Vec3> positions =
      MoveSurfacePoints(this->Target, SliverPlace::Elsewhere, isFree, true, mesh);
    std::vector<Vec3> points = this->Mesh.Points;
    std::vector<Id> moved;
    for (Id p = 0; p < static_cast<Id>(positions.size()); ++p)
    {
      if (positions[p] != parts.Surface.Points[p])
      {
        moved.push_back(p);
        points[parts.Sources[p]] = positions[p];
      }
    }
    // Moves that fill a sphere on the other side of an outer facet.
    const SphereCriteria criteria(points);
    bool isIntact = true;
    const auto check = [&](const auto& ids, const auto& isInside)
    {
      if (criteria.HasEmptySmallestSphere(parts.GetSources(ids)))
      {
        return;
      }
      isIntact = false;
      for (Id p : moved)
      {
        const bool isCorner = Contains(ids, p);
        isFree[p] &= isCorner || isInside(positions[p]) ? 0 : 1;
      }
    };
    for (const TriangleIds& ids : parts.Surface.Triangles)
    {
      check(ids,
        [&](const Vec3& other) {
          return InEquatorialSphere(
                   positions[ids[0]], positions[ids[1]], positions[ids[2]], other) > 0;
        });
    }
    for (const StructuralEdge& edge : parts.IntactEdges)
    {
      const EdgeIds& ids = edge.Points;
      check(ids,
        [&](const Vec3& other)
        { return InDiametralSphere(positions[ids[0]], positions[ids[1]], other) > 0; });
    }
    if (isIntact)
    {
      isMoved = !moved.empty();
      this->MovedPoints += static_cast<Id>(moved.size());
      this->PutTogether(parts, mesh.GetMesh());
      return Status();
    }
  }
  return Status();
}
} // namespace

Status MoveSliverPoints(double target, const std::vector<char>& isFree, bool areBoundaryPointsFree,
  const ExecutionContext& context, TetMesh& mesh, Id& movedPoints)
{
  SliverPointMoves moves(target, isFree, mesh, movedPoints);
  const double share = areBoundaryPointsFree ? 0.4 : 1.0;
  Status status = moves.MoveInside(context.Part(0.0, share));
  bool isMoved = false;
  if (status.IsOk() && areBoundaryPointsFree)
  {
    status = moves.MoveBoundary(context.Part(share, 0.8), isMoved);
  }
  if (status.IsOk() && isMoved)
  {
    status = moves.MoveInside(context.Part(0.8, 1.0));
  }
  return status;
}
} // namespace cdm
