// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Volume/SurfaceFacets.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/DuplicateTriangles.h"
#include "Core/Meshes/FacetPolygons.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Search/PointOctree.h"
#include "Core/Surface/SurfaceDelaunayTest.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
/** +1 if two orders of the same three points have the same orientation, else -1. */
int GetRelativeTurn(const TriangleIds& s, const TriangleIds& t)
{
  const int first = s[0] == t[0] ? 0 : s[0] == t[1] ? 1 : 2;
  return s[1] == t[(first + 1) % 3] ? 1 : -1;
}

class SurfaceFacetFinder
{
public:
  SurfaceFacetFinder(const SurfaceFacetsInput& input, const ExecutionContext& context,
    TriangleMesh& surface, SurfaceFacets& output)
    : Input(input), Context(context), Surface(surface), Output(output)
  {
  }

  Status Run();

private:
  void FindFacets(const std::vector<Id>& triangles);
  bool IsSurelyStronglyDelaunay(Id triangle) const;
  Status TurnDiagonals(const std::vector<Id>& doubtful, std::vector<Id>& changed);
  bool IsBeyondHull(Id tetrahedron) const
  {
    const TetrahedronIds& ids = this->Input.All.Tetrahedra[tetrahedron];
    return Contains(ids, static_cast<Id>(this->Input.Order.size()));
  }

  const SurfaceFacetsInput& Input;
  const ExecutionContext& Context;
  TriangleMesh& Surface;
  SurfaceFacets& Output;
};

Status SurfaceFacetFinder::Run()
{
  const std::vector<DuplicateTriangle> duplicates = FindDuplicateTriangles(this->Surface.Triangles);
  if (!duplicates.empty())
  {
    return Status::InvalidInput("Two triangles of the surface have the same points; clean the "
                                "surface with the boundary triangulator first.",
      { duplicates.front().Triangle });
  }
  const Id numberOfTriangles = static_cast<Id>(this->Surface.Triangles.size());
  std::vector<Id> all(numberOfTriangles);
  std::iota(all.begin(), all.end(), 0);
  this->Output.Sides.resize(2 * this->Surface.Triangles.size());
  this->FindFacets(all);
  std::vector<Id> doubtful;
  for (Id t = 0; t < numberOfTriangles; ++t)
  {
    if (!this->IsSurelyStronglyDelaunay(t))
    {
      doubtful.push_back(t);
    }
  }
  if (!doubtful.empty())
  {
    std::vector<Id> changed;
    const Status status = this->TurnDiagonals(doubtful, changed);
    if (!status.IsOk())
    {
      return status;
    }
    this->FindFacets(changed);
  }
  for (Id side = 0; side < 2 * numberOfTriangles; ++side)
  {
    if (this->Output.Sides[side] == NoId)
    {
      return Status::InternalError("A boundary triangle is no facet of the mesh.", { side / 2 });
    }
  }
  return Status();
}

/** changed: gets the triangles that have other points or another orientation now. */
Status SurfaceFacetFinder::TurnDiagonals(const std::vector<Id>& doubtful, std::vector<Id>& changed)
{
  const bool hasLabels = !this->Surface.Labels.empty();
  const FacetPolygons polygons(this->Surface, this->Input.Points.size());
  PointOctree octree;
  for (Id point : this->Input.Order)
  {
    octree.Insert(point, this->Input.Points[point]);
  }
  SurfaceDelaunayTest test(this->Input.Points, octree);
  SurfaceDelaunayTest::Result result;
  std::vector<Id> offending;
  std::vector<char> isDone(this->Surface.Triangles.size(), 0);
  std::vector<Id> polygonTriangles;
  for (std::size_t i = 0; i < doubtful.size(); ++i)
  {
    if (i % StepsBetweenChecks == 0 &&
      !this->Context.Continue(double(i) / double(doubtful.size()), "Checking the surface"))
    {
      return Status::Aborted();
    }
    const Id t = doubtful[i];
    if (isDone[t])
    {
      continue;
    }
    test.Run(this->Surface.Triangles[t], result);
    const std::vector<Id>& cocircular = result.Cocircular;
    const auto isCocircular = [&cocircular](Id point)
    { return std::binary_search(cocircular.begin(), cocircular.end(), point); };
    if (!result.IsDelaunay ||
      (!cocircular.empty() && polygons.Collect(t, isCocircular, polygonTriangles) != cocircular))
    {
      offending.push_back(t);
      continue;
    }
    if (cocircular.empty())
    {
      continue;
    }

    const std::vector<TriangleIds> fan =
      MakePulledFan(this->Input.Points, this->Surface.Triangles[t], cocircular);
    if (fan.size() != polygonTriangles.size())
    {
      return Status::Failure(StatusCode::SelfIntersecting,
        "Triangles of a flat facet overlap; check the surface with "
        "the boundary triangulator.",
        polygonTriangles);
    }
    const RegionPair labels = hasLabels ? this->Surface.Labels[t] : RegionPair{};
    for (std::size_t k = 0; k < fan.size(); ++k)
    {
      const Id triangle = polygonTriangles[k];
      const TriangleIds before = std::exchange(this->Surface.Triangles[triangle], fan[k]);
      const bool isTurned = Sorted(before) != Sorted(fan[k]);
      this->Output.TurnedDiagonals += isTurned ? 1 : 0;
      if (isTurned || GetRelativeTurn(before, fan[k]) < 0)
      {
        changed.push_back(triangle);
      }
      if (hasLabels)
      {
        this->Surface.Labels[triangle] = labels;
      }
      isDone[triangle] = 1;
    }
  }
  if (!offending.empty())
  {
    const std::string count = std::to_string(offending.size());
    return Status::Failure(StatusCode::NotDelaunay,
      count +
        " triangles of the surface are not strongly Delaunay; refine the surface with "
        "the surface refiner first (together with the mesh points, if there are any).",
      std::move(offending));
  }
  return Status();
}

/** Finds both sides of these triangles. */
void SurfaceFacetFinder::FindFacets(const std::vector<Id>& triangles)
{
  if (triangles.empty())
  {
    return;
  }
  // The triangles by their first vertex, with the other two in order.
  const std::size_t count = this->Input.Order.size();
  std::vector<Id> vertices(this->Input.Points.size(), NoId);
  for (std::size_t vertex = 0; vertex < count; ++vertex)
  {
    vertices[this->Input.Order[vertex]] = static_cast<Id>(vertex);
  }
  struct Candidate
  {
    Id Second;
    Id Third;
    Id Triangle;
  };
  const auto getVertices = [&](const TriangleIds& ids) {
    return Sorted(TriangleIds{ vertices[ids[0]], vertices[ids[1]], vertices[ids[2]] });
  };
  std::vector<Id> starts(count + 2, 0);
  std::vector<char> isOnSurface(count + 1, 0);
  for (const Id t : triangles)
  {
    this->Output.Sides[2 * t] = this->Output.Sides[2 * t + 1] = NoId;
    const TriangleIds ids = getVertices(this->Surface.Triangles[t]);
    ++starts[ids[0] + 2];
    for (Id vertex : ids)
    {
      isOnSurface[vertex] = 1;
    }
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Candidate> candidates(triangles.size());
  for (const Id t : triangles)
  {
    const TriangleIds ids = getVertices(this->Surface.Triangles[t]);
    candidates[starts[ids[0] + 1]++] = { ids[1], ids[2], t };
  }

  const auto find = [&](std::size_t t)
  {
    const TetrahedronIds& tetrahedron = this->Input.All.Tetrahedra[t];
    if (tetrahedron[0] == NoId ||
      isOnSurface[tetrahedron[0]] + isOnSurface[tetrahedron[1]] + isOnSurface[tetrahedron[2]] +
          isOnSurface[tetrahedron[3]] <
        3)
    {
      return;
    }
    for (int i = 0; i < 4; ++i)
    {
      const TriangleIds facet = GetFacet(tetrahedron, i);
      const Id neighbor = this->Input.All.Neighbors[t][i];
      if (neighbor < static_cast<Id>(4 * t) || !isOnSurface[facet[0]] || !isOnSurface[facet[1]] ||
        !isOnSurface[facet[2]])
      {
        continue;
      }
      const TriangleIds ids = Sorted(facet);
      for (Id k = starts[ids[0]]; k < starts[ids[0] + 1]; ++k)
      {
        const Candidate& candidate = candidates[k];
        if (candidate.Second == ids[1] && candidate.Third == ids[2])
        {
          // The tetrahedron lies behind its outward facet.
          const TriangleIds outward{ this->Input.Order[facet[0]], this->Input.Order[facet[1]],
            this->Input.Order[facet[2]] };
          const Id side =
            GetRelativeTurn(this->Surface.Triangles[candidate.Triangle], outward) < 0 ? 0 : 1;
          this->Output.Sides[2 * candidate.Triangle + side] = static_cast<Id>(4 * t + i);
          this->Output.Sides[2 * candidate.Triangle + 1 - side] = neighbor;
          break;
        }
      }
    }
  };
  // A triangle is a facet of one tetrahedron before its neighbor: threads never write to the same
  // place.
  ForEach(this->Input.All.Tetrahedra.size(), this->Input.NumberOfThreads, find);
}

/** True if one of the two tetrahedra at the triangle is a cell of four points. */
bool SurfaceFacetFinder::IsSurelyStronglyDelaunay(Id triangle) const
{
  if (this->Output.Sides[2 * triangle] == NoId || this->Output.Sides[2 * triangle + 1] == NoId)
  {
    return false;
  }
  if (!this->Input.All.HasCosphericalPoints)
  {
    return true;
  }
  const auto& p = this->Input.VertexPoints;
  for (Id side = 2 * triangle; side < 2 * triangle + 2; ++side)
  {
    const Id t = this->Output.Sides[side] / 4;
    const TetrahedronIds& ids = this->Input.All.Tetrahedra[t];
    bool isAlone = !this->IsBeyondHull(t);
    for (int i = 0; i < 4 && isAlone; ++i)
    {
      const Id facet = this->Input.All.Neighbors[t][i];
      isAlone = this->IsBeyondHull(facet / 4) ||
        InSphere(p[ids[0]], p[ids[1]], p[ids[2]], p[ids[3]],
          p[this->Input.All.Tetrahedra[facet / 4][facet % 4]]) != 0;
    }
    if (isAlone)
    {
      return true;
    }
  }
  return false;
}
} // namespace

Status FindSurfaceFacets(const SurfaceFacetsInput& input, const ExecutionContext& context,
  TriangleMesh& surface, SurfaceFacets& output)
{
  return SurfaceFacetFinder(input, context, surface, output).Run();
}
} // namespace cdm
