// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/DefaultSize.h"

#include "Core/Geometry/Box.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Meshes/VolumeSums.h"
#include "Core/Sizing/RegionLocator.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdm
{
namespace
{
constexpr double DiagonalRatio = 0.05;
constexpr double Tetrahedra = 25000.0;
/** Tetrahedra with edges of length 1: in a unit of volume, and at a unit of the surface. */
constexpr double TetrahedraPerVolume = 8.5;
constexpr double TetrahedraPerArea = 7.0;

struct RegionExtent
{
  CompensatedSum SixVolumes;
  double Area = 0.0;

  double GetVolume() const { return std::abs(this->SixVolumes.Get()) / 6.0; }
  double GetThickness() const { return 2.0 * this->GetVolume() / this->Area; }
};

/** Measures of each region. Empty if the regions are not known. */
std::map<Id, RegionExtent> MeasureRegions(const TriangleMesh& surface)
{
  std::map<Id, RegionExtent> regions;
  RegionLocator locator(surface);
  if (!locator.Build().IsOk())
  {
    return regions;
  }
  const Vec3& origin = surface.Points[surface.Triangles.front()[0]];
  for (std::size_t i = 0; i < surface.Triangles.size(); ++i)
  {
    const TriangleIds& ids = surface.Triangles[i];
    const Vec3& a = surface.Points[ids[0]];
    const Vec3& b = surface.Points[ids[1]];
    const Vec3& c = surface.Points[ids[2]];
    const long double volume = GetSixVolumes(origin, a, b, c);
    const double area = GetTriangleArea(a, b, c);
    const RegionPair pair = locator.GetRegions(static_cast<Id>(i));
    if (pair.Front == pair.Back)
    {
      continue;
    }
    for (const auto& [region, sign] : { std::pair(pair.Front, -1.0L), std::pair(pair.Back, 1.0L) })
    {
      if (region != OutsideRegion)
      {
        regions[region].SixVolumes.Add(sign * volume);
        regions[region].Area += area;
      }
    }
  }
  return regions;
}

} // namespace

double GetDefaultSize(const TriangleMesh& surface)
{
  if (surface.Triangles.empty())
  {
    return 0.0;
  }
  Box box;
  for (const TriangleIds& ids : surface.Triangles)
  {
    for (const Id id : ids)
    {
      box.Add(surface.Points[id]);
    }
  }
  const Vec3 sides = box.High - box.Low;
  const std::map<Id, RegionExtent> regions = MeasureRegions(surface);
  double volume = regions.empty() ? sides.X * sides.Y * sides.Z : 0.0;
  for (const auto& [region, extent] : regions)
  {
    volume += extent.GetVolume();
  }
  const double least = std::max(std::cbrt(volume * TetrahedraPerVolume / Tetrahedra),
    std::sqrt(GetSurfaceArea(surface) * TetrahedraPerArea / Tetrahedra));
  double size = DiagonalRatio * Norm(sides);
  for (const auto& [region, extent] : regions)
  {
    const double thickness = extent.GetThickness();
    if (thickness >= least)
    {
      size = std::min(size, thickness);
    }
  }
  return std::max(size, least);
}

double GetLeastThickness(const TriangleMesh& surface)
{
  double least = Infinity;
  if (!surface.Triangles.empty())
  {
    for (const auto& [region, extent] : MeasureRegions(surface))
    {
      least = std::min(least, extent.GetThickness());
    }
  }
  return least;
}
} // namespace cdm
