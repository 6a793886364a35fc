// SPDX-License-Identifier: BSD-3-Clause
#include "Devices/LayoutOverlay.h"

#include "Core/Geometry/Box.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Repair/BoundaryTriangulator.h"

#include <cmath>
#include <utility>

namespace cdm
{
namespace
{
/** Crossings of a ray towards growing x, with exact signs. */
bool IsInside(const PolygonSoup& polygons, Id polygon, const Vec3& p)
{
  const Id* vertices = polygons.GetPolygon(polygon);
  const Id size = polygons.GetPolygonSize(polygon);
  bool isInside = false;
  for (Id i = 0; i < size; ++i)
  {
    const Vec3& a = polygons.Points[vertices[i]];
    const Vec3& b = polygons.Points[vertices[(i + 1) % size]];
    const bool isUpwards = a.Y <= p.Y;
    if (isUpwards != (b.Y <= p.Y))
    {
      const int turn = ProjectedOrientation(2, a, b, p);
      isInside = (isUpwards ? turn > 0 : turn < 0) ? !isInside : isInside;
    }
  }
  return isInside;
}
} // namespace

Status OverlayPolygons(PolygonSoup polygons, const ExecutionContext& context, LayoutOverlay& output)
{
  output = {};
  for (Vec3& point : polygons.Points)
  {
    // Not what is there times 0, so that a z that is not finite is refused with the others.
    point.Z = std::isfinite(point.Z) ? 0.0 : point.Z;
  }
  BoundaryTriangulatorOptions options;
  options.ResolveSelfIntersections = true;
  options.Pieces = ResolvedPieces::All;
  BoundaryTriangulatorOutput pieces;
  Status status = TriangulateBoundary(polygons, options, context.Part(0.0, 0.7), pieces);
  if (!status.IsOk())
  {
    return status;
  }

  std::vector<Box> boxes(polygons.GetNumberOfPolygons());
  for (Id polygon = 0; polygon < polygons.GetNumberOfPolygons(); ++polygon)
  {
    for (Id i = 0; i < polygons.GetPolygonSize(polygon); ++i)
    {
      boxes[polygon].Add(polygons.Points[polygons.GetPolygon(polygon)[i]]);
    }
  }
  output.Points = std::move(pieces.Surface.Points);
  output.Pieces = std::move(pieces.Surface.Triangles);
  const ExecutionContext rest = context.Part(0.7, 1.0);
  for (std::size_t i = 0; i < output.Pieces.size(); ++i)
  {
    if (i % 256 == 0 &&
      !rest.Continue(static_cast<double>(i) / output.Pieces.size(), "Comparing masks"))
    {
      return Status::Aborted();
    }
    const TriangleIds& ids = output.Pieces[i];
    const Vec3 middle =
      (1.0 / 3.0) * (output.Points[ids[0]] + output.Points[ids[1]] + output.Points[ids[2]]);
    Box place;
    place.Add(middle);
    output.Polygons.emplace_back();
    for (Id polygon = 0; polygon < polygons.GetNumberOfPolygons(); ++polygon)
    {
      if (boxes[polygon].Overlaps(place) && IsInside(polygons, polygon, middle))
      {
        output.Polygons.back().push_back(polygon);
      }
    }
  }
  return {};
}
} // namespace cdm
