// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/ThinLayers.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace cdm
{
namespace
{
/** How many times as wide as thick a layer is at least by default, with a region beside it ... */
constexpr double UsualAspectRatio = 20.0;
/** ... and with the outside on both sides. */
constexpr double PlateAspectRatio = 100.0;
/** Cosine of a degree, the largest angle between normals of neighboring triangles of one side. */
constexpr double SmoothCosine = 0.9998476951563913;
/**
 * Cosine of the angles between the sides of a layer, and of a side's normal and an upright edge.
 */
constexpr double AcrossCosine = 0.85;
/**
 * Length of an upright edge across a layer, in lengths of the longest edge of its tetrahedron ...
 */
constexpr double ThinRatio = 0.75;
/** ... and thickness of the layer if the edge is not upright. */
constexpr double VeryThinRatio = 0.35;
/** Smaller heights above a side are zero up to rounding, in lengths of the edge. */
constexpr double FlatRatio = 1e-12;

Id GetRegion(const TriangleMesh& surface, Id face)
{
  const RegionPair& labels = surface.Labels[face / 2];
  return face % 2 == 0 ? labels.Back : labels.Front;
}
} // namespace

ThinLayers::ThinLayers(
  const TriangleMesh& surface, const IdLists& pointTriangles, double aspectRatio)
  : Surface(surface), PointTriangles(pointTriangles), AspectRatio(aspectRatio)
{
  for (Id t = 0; t < static_cast<Id>(surface.Triangles.size()); ++t)
  {
    const Vec3 normal = GetAreaVector(surface, surface.Triangles[t]);
    const RegionPair& labels = surface.Labels[t];
    this->Faces.push_back({ 1.0 / Norm(normal) * normal, 0.0, labels.Front == OutsideRegion });
    this->Faces.push_back({ -1.0 / Norm(normal) * normal, 0.0, labels.Back == OutsideRegion });
    this->NumberOfVisits += 2;
  }
  this->MeasureWidths();
}

void ThinLayers::Follow(const std::vector<Id>& triangles, const std::vector<Id>& parents)
{
  // A parent may be among the triangles.
  std::vector<Face> faces;
  for (Id parent : parents)
  {
    faces.push_back(this->Faces[2 * parent]);
    faces.push_back(this->Faces[2 * parent + 1]);
    this->NumberOfVisits += 2;
  }
  this->Faces.resize(2 * this->Surface.Triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    this->Faces[2 * triangles[i]] = faces[2 * i];
    this->Faces[2 * triangles[i] + 1] = faces[2 * i + 1];
  }
}

void ThinLayers::MeasureWidths()
{
  const std::size_t count = this->Faces.size();
  DisjointSets sides(count);
  // Faces and the lengths of their edges at which the side ends.
  std::vector<std::pair<Id, double>> rims;
  const std::vector<EdgeUse> uses =
    SortEdgeUses(this->Surface.Triangles, this->Surface.Points.size());
  std::vector<Id> around;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    around.clear();
    for (; end < uses.size() && uses[end].Edge == uses[begin].Edge; ++end)
    {
      around.push_back(2 * (uses[end].Use / 3));
      around.push_back(2 * (uses[end].Use / 3) + 1);
    }
    const EdgeIds ends = uses[begin].GetPoints();
    const double length = Distance(this->Surface.Points[ends[0]], this->Surface.Points[ends[1]]);
    for (Id face : around)
    {
      const Id region = GetRegion(this->Surface, face);
      bool goesOn = false;
      for (Id other : around)
      {
        if (other != face && GetRegion(this->Surface, other) == region &&
          Dot(this->Faces[face].Normal, this->Faces[other].Normal) > SmoothCosine)
        {
          sides.Unite(face, other);
          goesOn = true;
        }
      }
      if (!goesOn)
      {
        rims.emplace_back(face, length);
      }
    }
  }

  std::vector<double> areas(count, 0.0);
  std::vector<double> perimeters(count, 0.0);
  for (const auto& [face, length] : rims)
  {
    perimeters[sides.Find(face)] += length;
  }
  for (Id face = 0; face < static_cast<Id>(count); ++face)
  {
    areas[sides.Find(face)] +=
      0.5 * Norm(GetAreaVector(this->Surface, this->Surface.Triangles[face / 2]));
  }
  for (Id face = 0; face < static_cast<Id>(count); ++face)
  {
    const Id side = sides.Find(face);
    const double square = std::sqrt(areas[side]);
    this->Faces[face].Width =
      perimeters[side] * square > 4.0 * areas[side] ? 4.0 * areas[side] / perimeters[side] : square;
  }
}

/** The face of a triangle as seen from a region; null if the triangle does not bound the region. */
const ThinLayers::Face* ThinLayers::GetFace(Id triangle, Id region) const
{
  const RegionPair& labels = this->Surface.Labels[triangle];
  return labels.Back == region ? &this->Faces[2 * triangle]
    : labels.Front == region   ? &this->Faces[2 * triangle + 1]
                               : nullptr;
}

bool ThinLayers::AreOpposite(const Face& first, const Face& second)
{
  return Dot(first.Normal, second.Normal) <= -AcrossCosine;
}

bool ThinLayers::IsThin(const Face& first, const Face& second, double thickness) const
{
  const double ratio = this->AspectRatio > 0.0 ? this->AspectRatio
    : first.IsOuter && second.IsOuter          ? PlateAspectRatio
                                               : UsualAspectRatio;
  return ratio * thickness <= std::min(first.Width, second.Width);
}

bool ThinLayers::IsAcross(const TetrahedronIds& ids, Id region) const
{
  const std::vector<Vec3>& points = this->Surface.Points;
  if (*std::max_element(ids.begin(), ids.end()) >= static_cast<Id>(points.size()))
  {
    return false;
  }
  // No layer is thin that is thicker than this part of a side's width.
  const double least =
    std::max(1.0, this->AspectRatio > 0.0 ? this->AspectRatio : UsualAspectRatio);
  double longest = 0.0;
  for (const auto& edge : TetrahedronEdges)
  {
    longest = std::max(longest, Distance(points[ids[edge[0]]], points[ids[edge[1]]]));
  }
  return std::any_of(std::begin(TetrahedronEdges), std::end(TetrahedronEdges),
    [&](const int(&edge)[2])
    {
      const Vec3 direction = points[ids[edge[1]]] - points[ids[edge[0]]];
      const double length = Norm(direction);
      for (Id t : this->PointTriangles[ids[edge[0]]])
      {
        const Face* const first = this->GetFace(t, region);
        // How far it is to the other side.
        const double height = first != nullptr ? -Dot(first->Normal, direction) : 0.0;
        const bool isUpright = height >= AcrossCosine * length && length <= ThinRatio * longest;
        if (height <= FlatRatio * length || least * height > first->Width ||
          (!isUpright && height > VeryThinRatio * longest))
        {
          continue;
        }
        for (Id u : this->PointTriangles[ids[edge[1]]])
        {
          const Face* const second = this->GetFace(u, region);
          if (second == nullptr || !AreOpposite(*first, *second))
          {
            continue;
          }
          // Where a curved sheet bends, the far point is closer to the plane of the next facet than
          // the sheet is thick.
          const double thickness = std::max(height, Dot(second->Normal, direction));
          if (this->IsThin(*first, *second, thickness))
          {
            return true;
          }
        }
      }
      return false;
    });
}
} // namespace cdm
