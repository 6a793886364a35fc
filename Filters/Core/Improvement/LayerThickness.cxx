// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/LayerThickness.h"

#include "Core/Meshes/SurfaceArea.h"

#include <algorithm>
#include <cmath>
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

/** The share of the way at which it meets the triangle; infinite if it does not. */
double FindMeeting(
  const Vec3& position, const Vec3& way, const Vec3& a, const Vec3& b, const Vec3& c)
{
  constexpr double never = Infinity;
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
    Thin(this->Surface, this->PointTriangles, aspectRatio),
    Tree(MakeBoxes(this->Surface.Points, this->Surface.Triangles))
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

/** The feet of the position's perpendiculars on the triangles, if they are nearer than the reach. */
std::vector<LayerThickness::Foot> LayerThickness::ListFeet(const Vec3& position, double reach) const
{
  std::vector<Foot> feet;
  this->Tree.VisitOverlaps(Box::MakeAround(position, reach),
    [&](Id t)
    {
      const auto [a, b, c] = GetCorners(this->Surface, t);
      const Vec3 normal = Cross(b - a, c - a);
      const double height = Dot(normal, position - a) / Norm(normal);
      const Vec3 way = (-2.0 * height / Norm(normal)) * normal;
      if (height != 0.0 && std::abs(height) < reach && FindMeeting(position, way, a, b, c) < 1.0)
      {
        const Id face = 2 * t + (height > 0.0 ? 1 : 0);
        feet.push_back(
          { face, std::abs(height), (std::copysign(1.0, height) / Norm(normal)) * normal });
      }
    });
  return feet;
}

std::vector<LayerThickness::Layer> LayerThickness::Find(const Vec3& position, double limit) const
{
  std::vector<Layer> layers;
  for (const Foot& foot : this->ListFeet(position, 0.5 * limit))
  {
    const Id near = foot.Face / 2;
    const double left = limit - foot.Height;
    double share = 0.0;
    // Nothing may lie between.
    if (this->FindFirst(position, -2.0 * foot.Height * foot.Direction, share) != near)
    {
      continue;
    }
    const Id far = this->FindFirst(position, left * foot.Direction, share);
    if (far == NoId || !this->Contacts.AreDisjoint(this->Facets[near], this->Facets[far]))
    {
      continue;
    }
    const double thickness = foot.Height + share * left;
    const Vec3 farNormal = GetAreaVector(this->Surface, this->Surface.Triangles[far]);
    const Id farFace = 2 * far + (Dot(farNormal, foot.Direction) < 0.0 ? 1 : 0);
    if (this->Thin.AreOpposite(foot.Face, farFace) &&
      !this->Thin.IsThin(foot.Face, farFace, thickness))
    {
      layers.push_back({ thickness, foot.Direction });
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
      double low = Infinity;
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
