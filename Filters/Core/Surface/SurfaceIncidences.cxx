// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceIncidences.h"

#include <cmath>

namespace cdm
{
SurfaceIncidences::SurfaceIncidences(const RefinableSurface& surface,
  const std::vector<Vec3>& points, Id numberOfSurfacePoints, double flatness)
  : Surface(surface), Points(points), NumberOfSurfacePoints(numberOfSurfacePoints),
    NumberOfGivenPoints(static_cast<Id>(points.size())),
    InnerRadii(numberOfSurfacePoints, Infinity), AcuteCorners(numberOfSurfacePoints, -1)
{
  this->CollectFacets();
  this->CollectEdges();
  this->CollectNormals(flatness);
  this->CollectCorners();
}

void SurfaceIncidences::CollectFacets()
{
  std::vector<std::pair<Id, Id>> pairs;
  pairs.reserve(3 * static_cast<std::size_t>(this->Surface.GetNumberOfTriangles()));
  for (Id t = 0; t < this->Surface.GetNumberOfTriangles(); ++t)
  {
    const RefinableSurface::Triangle& triangle = this->Surface.GetTriangle(t);
    for (Id point : triangle.Points)
    {
      pairs.emplace_back(point, triangle.Facet);
    }
  }
  std::stable_sort(
    pairs.begin(), pairs.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  this->PointFacets.Build(this->NumberOfSurfacePoints, pairs);
}

void SurfaceIncidences::CollectEdges()
{
  std::vector<std::pair<Id, Id>> pairs;
  std::vector<std::pair<Id, Id>> edgeFacets;
  for (Id s = 0; s < this->Surface.GetNumberOfSegments(); ++s)
  {
    const EdgeIds& edge = this->Surface.GetSegment(s).Points;
    pairs.emplace_back(edge[0], s);
    pairs.emplace_back(edge[1], s);
    const std::vector<Id> facets = this->Surface.GetFacets(s);
    for (std::size_t i = 0; i < facets.size(); ++i)
    {
      edgeFacets.emplace_back(s, facets[i]);
      for (std::size_t j = i + 1; j < facets.size(); ++j)
      {
        this->SharedEdges.emplace_back(GetPair(facets[i], facets[j]), s);
      }
    }
  }
  this->PointEdges.Build(this->NumberOfSurfacePoints, pairs);
  this->EdgeFacets.Build(this->Surface.GetNumberOfSegments(), edgeFacets);
  std::sort(this->SharedEdges.begin(), this->SharedEdges.end());
}

void SurfaceIncidences::CollectNormals(double flatness)
{
  const Id count = this->Surface.GetNumberOfTriangles();
  const auto getNormal = [this](Id t)
  {
    const TriangleIds& ids = this->Surface.GetTriangle(t).Points;
    const Vec3& a = this->Points[ids[0]];
    return Cross(this->Points[ids[1]] - a, this->Points[ids[2]] - a);
  };
  // The normal of the largest triangle of each facet is the most accurate one.
  std::vector<std::pair<double, Id>> largest;
  for (Id t = 0; t < count; ++t)
  {
    const RefinableSurface::Triangle& triangle = this->Surface.GetTriangle(t);
    const double size = Norm(getNormal(t));
    largest.resize(
      std::max(largest.size(), static_cast<std::size_t>(triangle.Facet) + 1), { 0.0, NoId });
    largest[triangle.Facet] = std::max(largest[triangle.Facet], std::make_pair(size, t));
  }
  this->Normals.resize(largest.size());
  for (std::size_t facet = 0; facet < largest.size(); ++facet)
  {
    if (largest[facet].second != NoId)
    {
      this->Normals[facet] = (1.0 / largest[facet].first) * getNormal(largest[facet].second);
    }
  }
  for (Id t = 0; t < count && std::isfinite(flatness); ++t)
  {
    const RefinableSurface::Triangle& triangle = this->Surface.GetTriangle(t);
    const Id model = largest[triangle.Facet].second;
    for (Id p : triangle.Points)
    {
      const Vec3 arm = this->Points[p] - this->Points[this->Surface.GetTriangle(model).Points[0]];
      if (std::abs(Dot(arm, this->Normals[triangle.Facet])) > flatness)
      {
        this->Normals[triangle.Facet] = Vec3();
        break;
      }
    }
  }
}

void SurfaceIncidences::CollectCorners()
{
  std::vector<std::pair<Id, Id>> corners;
  for (Id p = 0; p < this->NumberOfSurfacePoints; ++p)
  {
    if (!this->PointEdges[p].empty())
    {
      for (Id facet : this->PointFacets[p])
      {
        corners.emplace_back(facet, p);
      }
    }
  }
  this->Corners.Build(static_cast<Id>(this->Normals.size()), corners);
}

void SurfaceIncidences::AddPoint(Id facet, Id inputEdge)
{
  this->NewPointFacets.push_back(facet);
  this->NewPointEdges.push_back(inputEdge);
  if (inputEdge == NoId)
  {
    return;
  }
  const Vec3& position =
    this->Points[this->NumberOfGivenPoints + static_cast<Id>(this->NewPointEdges.size()) - 1];
  for (Id end : this->Surface.GetInputEdges()[inputEdge])
  {
    double& radius = this->InnerRadii[end];
    radius = std::min(radius, Distance(position, this->Points[end]));
  }
}

IdLists::Range SurfaceIncidences::GetFacets(Id point) const
{
  if (point < this->NumberOfSurfacePoints)
  {
    return this->PointFacets[point];
  }
  if (point < this->NumberOfGivenPoints)
  {
    return {};
  }
  const Id* const facet = &this->NewPointFacets[point - this->NumberOfGivenPoints];
  const Id edge = this->NewPointEdges[point - this->NumberOfGivenPoints];
  return *facet != NoId ? IdLists::Range{ facet, facet + 1 }
    : edge != NoId      ? this->EdgeFacets[edge]
                        : IdLists::Range();
}

IdLists::Range SurfaceIncidences::GetEdges(Id point) const
{
  if (point < this->NumberOfSurfacePoints)
  {
    return this->PointEdges[point];
  }
  if (point < this->NumberOfGivenPoints)
  {
    return {};
  }
  const Id* const edge = &this->NewPointEdges[point - this->NumberOfGivenPoints];
  return { edge, edge + (*edge != NoId ? 1 : 0) };
}

bool SurfaceIncidences::IsAcuteCorner(Id point)
{
  if (point >= this->NumberOfSurfacePoints)
  {
    return false;
  }
  signed char& isAcute = this->AcuteCorners[point];
  if (isAcute < 0)
  {
    isAcute = 0;
    const IdLists::Range incident = this->PointEdges[point];
    const auto getArm = [this, point](Id edge)
    {
      const EdgeIds& ends = this->Surface.GetInputEdges()[edge];
      return this->Points[ends[0] == point ? ends[1] : ends[0]] - this->Points[point];
    };
    for (const Id* i = incident.begin(); i != incident.end() && isAcute == 0; ++i)
    {
      const Vec3 u = getArm(*i);
      for (const Id* j = i + 1; j != incident.end() && isAcute == 0; ++j)
      {
        const Vec3 v = getArm(*j);
        isAcute = Dot(u, v) > 1e-9 * Norm(u) * Norm(v) ? 1 : 0;
      }
    }
  }
  return isAcute != 0;
}
} // namespace cdm
