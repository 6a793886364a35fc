// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/LayerThickness.h"

#include "Core/Meshes/SurfaceArea.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cdm
{
namespace
{
/** A line that passes a triangle by so little of its size meets it, up to rounding. */
constexpr double PassTolerance = 1e-9;

std::array<Vec3, 3> GetCorners(const TriangleMesh& surface, Id triangle)
{
  const TriangleIds& ids = surface.Triangles[triangle];
  return { surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]] };
}

std::vector<Box> MakeBoxes(const TriangleMesh& surface)
{
  std::vector<Box> boxes(surface.Triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
  {
    for (Id id : surface.Triangles[t])
    {
      boxes[t].Add(surface.Points[id]);
    }
  }
  return boxes;
}

/** The share of the way at which it meets the triangle; infinite if it does not. */
double FindMeeting(
  const Vec3& position, const Vec3& way, const Vec3& a, const Vec3& b, const Vec3& c)
{
  constexpr double never = std::numeric_limits<double>::infinity();
  const Vec3 normal = Cross(b - a, c - a);
  const double slope = Dot(normal, way);
  if (slope == 0.0)
  {
    return never;
  }
  const Vec3 offset = position - a;
  // Barycentric coordinates of the meeting, by the rule of Cramer.
  const Vec3 turned = Cross(way, offset);
  const double first = Dot(turned, c - a) / slope;
  const double second = -Dot(turned, b - a) / slope;
  const bool isInside =
    first >= -PassTolerance && second >= -PassTolerance && first + second <= 1.0 + PassTolerance;
  return isInside ? -Dot(normal, offset) / slope : never;
}
} // namespace

LayerThickness::LayerThickness(TriangleMesh surface, std::vector<Id> facets, double aspectRatio)
  : Surface(std::move(surface)), Facets(std::move(facets)),
    Contacts(static_cast<Id>(this->Surface.Points.size()), this->Surface.Triangles, this->Facets),
    PointTriangles(ListTrianglesAtPoints(this->Surface.Triangles, this->Surface.Points.size())),
    Thin(this->Surface, this->PointTriangles, aspectRatio), Tree(MakeBoxes(this->Surface))
{
}

/** The first triangle on a way. @param share of the way, at which it is met */
Id LayerThickness::FindFirst(const Vec3& position, const Vec3& way, double& share) const
{
  Id first = NoId;
  share = 1.0;
  Box box;
  box.Add(position);
  box.Add(position + way);
  this->Tree.VisitOverlaps(box,
    [&](Id t)
    {
      const auto [a, b, c] = GetCorners(this->Surface, t);
      const double met = FindMeeting(position, way, a, b, c);
      if (met > 0.0 && (met < share || (met == share && t < first)))
      {
        share = met;
        first = t;
      }
    });
  return first;
}

/** The triangles nearer than the reach that have the foot of the position's perpendicular in them. */
std::vector<Id> LayerThickness::ListFootTriangles(const Vec3& position, double reach) const
{
  std::vector<Id> found;
  this->Tree.VisitOverlaps(Box::MakeAround(position, reach),
    [&](Id t)
    {
      const auto [a, b, c] = GetCorners(this->Surface, t);
      const Vec3 normal = Cross(b - a, c - a);
      const double height = Dot(normal, position - a) / Norm(normal);
      const Vec3 way = (-2.0 * height / Norm(normal)) * normal;
      if (height != 0.0 && std::abs(height) < reach && FindMeeting(position, way, a, b, c) < 1.0)
      {
        found.push_back(t);
      }
    });
  return found;
}

std::vector<LayerThickness::Layer> LayerThickness::Find(const Vec3& position, double limit) const
{
  std::vector<Layer> layers;
  for (Id near : this->ListFootTriangles(position, 0.5 * limit))
  {
    const Vec3 normal = GetAreaVector(this->Surface, this->Surface.Triangles[near]);
    const Vec3& corner = this->Surface.Points[this->Surface.Triangles[near][0]];
    const double height = Dot(normal, position - corner) / Norm(normal);
    const Vec3 direction = (std::copysign(1.0, height) / Norm(normal)) * normal;
    const double left = limit - std::abs(height);
    double share = 0.0;
    // Nothing may lie between.
    if (this->FindFirst(position, -2.0 * std::abs(height) * direction, share) != near)
    {
      continue;
    }
    const Id far = this->FindFirst(position, left * direction, share);
    if (far == NoId || !this->Contacts.AreDisjoint(this->Facets[near], this->Facets[far]))
    {
      continue;
    }
    const double thickness = std::abs(height) + share * left;
    const Vec3 farNormal = GetAreaVector(this->Surface, this->Surface.Triangles[far]);
    const Id nearFace = 2 * near + (height > 0.0 ? 1 : 0);
    const Id farFace = 2 * far + (Dot(farNormal, direction) < 0.0 ? 1 : 0);
    if (this->Thin.AreOpposite(nearFace, farFace) &&
      !this->Thin.IsThin(nearFace, farFace, thickness))
    {
      layers.push_back({ thickness, direction });
    }
  }
  return layers;
}

bool LayerThickness::IsTooThick(
  const std::array<Vec3, 4>& vertices, double longest, int across) const
{
  const Vec3 centroid = 0.25 * (vertices[0] + vertices[1] + vertices[2] + vertices[3]);
  const std::vector<Layer> layers = this->Find(centroid, across * longest);
  return std::any_of(layers.begin(), layers.end(),
    [&](const Layer& layer)
    {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const Vec3& vertex : vertices)
      {
        const double height = Dot(layer.Direction, vertex - centroid);
        low = std::min(low, height);
        high = std::max(high, height);
      }
      return across * (high - low) > layer.Thickness;
    });
}
} // namespace cdm
