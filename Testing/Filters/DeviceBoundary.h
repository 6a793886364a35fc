// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DeviceBoundary.h
 * @brief Judges the boundary of a device by itself: closed regions, volumes in closed form, and no
 * point where it does not belong, all by brute force.
 */
#ifndef DeviceBoundary_h
#define DeviceBoundary_h

#include "FilterTesting.h"
#include "vtkTechnologyStructureSource.h"

#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace testing_devices
{
using Point = std::array<double, 3>;
using Vector = std::array<long double, 3>;
using Loop = std::vector<vtkIdType>;

constexpr double Pi = 3.14159265358979323846;

struct Boundary
{
  std::vector<Point> Points;
  std::vector<Loop> Polygons;
  std::vector<std::array<int, 2>> Labels;
  std::vector<int> FacetIds;
  std::vector<std::string> RegionNames;
};

/** Regions with these volumes and Euler characteristics. */
struct ExpectedRegion
{
  std::string Name;
  double Volume;
  int EulerCharacteristic;
};

inline Boundary GetBoundary(vtkTechnologyStructureSource* source)
{
  source->Update();
  vtkPolyData* output = source->GetOutput();
  Boundary boundary;
  auto* labels = vtkIntArray::SafeDownCast(output->GetCellData()->GetArray("BoundaryLabels"));
  auto* facets = vtkIntArray::SafeDownCast(output->GetCellData()->GetArray("FacetId"));
  boundary.RegionNames = testing_filters::GetTexts(output, "RegionNames");
  if (!labels || !facets || boundary.RegionNames.empty())
  {
    ADD_FAILURE() << "arrays are missing";
    return boundary;
  }
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(labels->GetNumberOfComponents(), 2);
  EXPECT_STREQ(labels->GetComponentName(0), "front");
  EXPECT_STREQ(labels->GetComponentName(1), "back");
  EXPECT_EQ(output->GetNumberOfPolys(), output->GetNumberOfCells());
  EXPECT_EQ(labels->GetNumberOfTuples(), output->GetNumberOfCells());
  EXPECT_EQ(facets->GetNumberOfTuples(), output->GetNumberOfCells());
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    Point point;
    output->GetPoint(i, point.data());
    boundary.Points.push_back(point);
  }
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < output->GetNumberOfCells(); ++i)
  {
    output->GetCellPoints(i, ids);
    const vtkIdType* first = ids->GetPointer(0);
    boundary.Polygons.emplace_back(first, first + ids->GetNumberOfIds());
    boundary.Labels.push_back({ labels->GetTypedComponent(i, 0), labels->GetTypedComponent(i, 1) });
    boundary.FacetIds.push_back(facets->GetValue(i));
  }
  return boundary;
}

inline Vector Subtract(const Point& a, const Point& b)
{
  return { static_cast<long double>(a[0]) - b[0], static_cast<long double>(a[1]) - b[1],
    static_cast<long double>(a[2]) - b[2] };
}

inline Vector Cross(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

inline long double Dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline long double Norm(const Vector& a)
{
  return std::sqrt(Dot(a, a));
}

/** Area times normal. */
inline Vector GetAreaVector(const Boundary& boundary, const Loop& loop)
{
  Vector area{};
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
  {
    const Point& origin = boundary.Points[loop[0]];
    const Vector triangle = Cross(
      Subtract(boundary.Points[loop[i]], origin), Subtract(boundary.Points[loop[i + 1]], origin));
    for (int axis = 0; axis < 3; ++axis)
    {
      area[axis] += 0.5L * triangle[axis];
    }
  }
  return area;
}

/** The polygons of a region, seen from outside of it. */
inline std::vector<Loop> GetRegionBoundary(const Boundary& boundary, int region)
{
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < boundary.Polygons.size(); ++i)
  {
    if (boundary.Labels[i][1] == region)
    {
      loops.push_back(boundary.Polygons[i]);
    }
    else if (boundary.Labels[i][0] == region)
    {
      loops.emplace_back(boundary.Polygons[i].rbegin(), boundary.Polygons[i].rend());
    }
  }
  return loops;
}

/** The divergence theorem, with the origin in the region so that nothing cancels. */
inline long double GetVolume(const Boundary& boundary, const std::vector<Loop>& loops)
{
  const Point& origin = boundary.Points[loops[0][0]];
  long double volume = 0.0L;
  for (const Loop& loop : loops)
  {
    volume += Dot(Subtract(boundary.Points[loop[0]], origin), GetAreaVector(boundary, loop)) / 3.0L;
  }
  return volume;
}

inline double GetExtent(const Boundary& boundary)
{
  double extent = 0.0;
  for (const Point& point : boundary.Points)
  {
    extent = std::max(extent, std::hypot(point[0], point[1], point[2]));
  }
  return extent;
}

inline double GetDistanceToSegment(const Point& p, const Point& a, const Point& b)
{
  const Vector direction = Subtract(b, a);
  const long double position =
    std::clamp(Dot(Subtract(p, a), direction) / Dot(direction, direction), 0.0L, 1.0L);
  Vector offset = Subtract(p, a);
  for (int axis = 0; axis < 3; ++axis)
  {
    offset[axis] -= position * direction[axis];
  }
  return static_cast<double>(Norm(offset));
}

/** True if p, a point of the polygon's plane, lies in it; crossings of a ray in the projection. */
inline bool IsInside(
  const Boundary& boundary, const Loop& loop, const Vector& normal, const Point& p)
{
  int axis = 0;
  for (int i = 1; i < 3; ++i)
  {
    axis = std::abs(normal[i]) > std::abs(normal[axis]) ? i : axis;
  }
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  bool isInside = false;
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const Point& a = boundary.Points[loop[i]];
    const Point& b = boundary.Points[loop[(i + 1) % loop.size()]];
    if ((a[v] > p[v]) != (b[v] > p[v]) &&
      p[u] < a[u] + (b[u] - a[u]) * (p[v] - a[v]) / (b[v] - a[v]))
    {
      isInside = !isInside;
    }
  }
  return isInside;
}

inline void CheckPoints(const Boundary& boundary)
{
  const std::set<Point> positions(boundary.Points.begin(), boundary.Points.end());
  EXPECT_EQ(positions.size(), boundary.Points.size()) << "duplicate points";
  std::set<vtkIdType> used;
  for (const Loop& loop : boundary.Polygons)
  {
    EXPECT_GE(loop.size(), 3u);
    EXPECT_EQ(std::set<vtkIdType>(loop.begin(), loop.end()).size(), loop.size());
    used.insert(loop.begin(), loop.end());
  }
  EXPECT_EQ(used.size(), boundary.Points.size()) << "unused points";
}

inline void CheckPolygons(const Boundary& boundary, const std::vector<ExpectedRegion>& regions)
{
  std::set<std::set<vtkIdType>> vertexSets;
  std::map<int, std::pair<std::array<int, 2>, Vector>> facets;
  for (std::size_t i = 0; i < boundary.Polygons.size(); ++i)
  {
    const Loop& loop = boundary.Polygons[i];
    vertexSets.emplace(loop.begin(), loop.end());
    const auto [front, back] = boundary.Labels[i];
    EXPECT_GE(front, -1);
    EXPECT_LT(front, back) << "the normal points to the smaller region id";
    EXPECT_LT(back, static_cast<int>(regions.size()));
    Vector normal = GetAreaVector(boundary, loop);
    const long double area = Norm(normal);
    EXPECT_GT(area, 0.0L);
    for (long double& component : normal)
    {
      component /= area;
    }
    const auto [facet, isNew] =
      facets.emplace(boundary.FacetIds[i], std::make_pair(boundary.Labels[i], normal));
    EXPECT_EQ(facet->second.first, boundary.Labels[i]);
    EXPECT_NEAR(static_cast<double>(Dot(facet->second.second, normal)), 1.0, 1e-12);
  }
  EXPECT_EQ(vertexSets.size(), boundary.Polygons.size()) << "duplicate polygons";
  EXPECT_EQ(facets.rbegin()->first, static_cast<int>(facets.size()) - 1) << "gaps in FacetId";
}

/** No point on an edge or in a polygon of which it is no vertex. */
inline void CheckNoTJunctions(const Boundary& boundary)
{
  const double tolerance = 1e-12 * GetExtent(boundary);
  for (const Loop& loop : boundary.Polygons)
  {
    const Vector area = GetAreaVector(boundary, loop);
    for (std::size_t point = 0; point < boundary.Points.size(); ++point)
    {
      if (std::find(loop.begin(), loop.end(), static_cast<vtkIdType>(point)) != loop.end())
      {
        continue;
      }
      const Point& p = boundary.Points[point];
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        ASSERT_GT(GetDistanceToSegment(
                    p, boundary.Points[loop[i]], boundary.Points[loop[(i + 1) % loop.size()]]),
          tolerance)
          << "point " << point << " lies on an edge";
      }
      const long double height = Dot(Subtract(p, boundary.Points[loop[0]]), area) / Norm(area);
      ASSERT_FALSE(std::abs(height) < tolerance && IsInside(boundary, loop, area, p))
        << "point " << point << " lies in a polygon";
    }
  }
}

/**
 * Each region is a closed manifold with the expected volume; the volumes add up. Rounded:
 * coordinates are turned, or sums of several lengths.
 */
inline void CheckRegions(
  const Boundary& boundary, const std::vector<ExpectedRegion>& regions, bool isRounded)
{
  ASSERT_EQ(boundary.RegionNames.size(), regions.size());
  long double total = 0.0L;
  long double allowedTotal = 0.0L;
  for (std::size_t region = 0; region < regions.size(); ++region)
  {
    SCOPED_TRACE(regions[region].Name);
    EXPECT_EQ(boundary.RegionNames[region], regions[region].Name);
    const std::vector<Loop> loops = GetRegionBoundary(boundary, static_cast<int>(region));
    std::set<std::pair<vtkIdType, vtkIdType>> edges;
    std::set<vtkIdType> vertices;
    long double area = 0.0L;
    for (const Loop& loop : loops)
    {
      area += Norm(GetAreaVector(boundary, loop));
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        vertices.insert(loop[i]);
        EXPECT_TRUE(edges.emplace(loop[i], loop[(i + 1) % loop.size()]).second)
          << "two polygons run along one edge in one direction";
      }
    }
    for (const auto& [begin, end] : edges)
    {
      EXPECT_EQ(edges.count({ end, begin }), 1u) << "open edge " << begin << ", " << end;
    }
    EXPECT_EQ(static_cast<int>(vertices.size()) - static_cast<int>(edges.size() / 2) +
        static_cast<int>(loops.size()),
      regions[region].EulerCharacteristic);

    // A point is off by a few roundings then, which moves the whole surface by as much.
    const long double allowed = isRounded
      ? 4.0 * std::numeric_limits<double>::epsilon() * GetExtent(boundary) * area
      : 1e-14L * regions[region].Volume;
    const long double volume = GetVolume(boundary, loops);
    EXPECT_NEAR(static_cast<double>(volume), regions[region].Volume, static_cast<double>(allowed));
    total += volume;
    allowedTotal += allowed;
  }
  std::vector<Loop> outside = GetRegionBoundary(boundary, -1);
  EXPECT_NEAR(static_cast<double>(-GetVolume(boundary, outside)), static_cast<double>(total),
    static_cast<double>(allowedTotal));
}

/** Parallel to two axes, or a rectangle over a segment: three exact cases of planarity. */
inline void CheckExactlyPlanar(const Boundary& boundary)
{
  for (const Loop& loop : boundary.Polygons)
  {
    std::set<double> values[3];
    std::set<std::pair<double, double>> projections[3];
    for (const vtkIdType vertex : loop)
    {
      const Point& p = boundary.Points[vertex];
      for (int axis = 0; axis < 3; ++axis)
      {
        values[axis].insert(p[axis]);
        projections[axis].emplace(p[(axis + 1) % 3], p[(axis + 2) % 3]);
      }
    }
    bool isPlanar = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      isPlanar = isPlanar || values[axis].size() == 1 || projections[axis].size() == 2;
    }
    EXPECT_TRUE(isPlanar);
  }
}

inline void CheckBoundary(
  const Boundary& boundary, const std::vector<ExpectedRegion>& regions, bool isRounded = false)
{
  ASSERT_FALSE(boundary.Polygons.empty());
  CheckPoints(boundary);
  CheckPolygons(boundary, regions);
  CheckNoTJunctions(boundary);
  CheckRegions(boundary, regions, isRounded);
  CheckExactlyPlanar(boundary);
}

/** Rotated, a device has the same polygons; only the coordinates differ. */
inline void CheckRotations(
  vtkTechnologyStructureSource* source, const std::vector<ExpectedRegion>& regions)
{
  const Boundary straight = GetBoundary(source);
  const double angles[] = { 10.0, 45.0, -123.456, 1e-6, 725.0 };
  const double axes[][3] = { { 0.0, 0.0, 1.0 }, { 1.0, 0.0, 0.0 }, { 1.0, 2.0, 3.0 },
    { -1e-200, 3e-200, 0.0 } };
  for (const double angle : angles)
  {
    for (const auto& axis : axes)
    {
      SCOPED_TRACE(angle);
      source->SetRotationAngle(angle);
      source->SetRotationAxis(axis);
      const Boundary rotated = GetBoundary(source);
      EXPECT_EQ(rotated.Polygons, straight.Polygons);
      EXPECT_EQ(rotated.Labels, straight.Labels);
      EXPECT_EQ(rotated.FacetIds, straight.FacetIds);
      ASSERT_EQ(rotated.Points.size(), straight.Points.size());
      CheckPoints(rotated);
      CheckNoTJunctions(rotated);
      CheckRegions(rotated, regions, true);

      // A second way to rotate: along the axis, towards the point, and across both.
      const double norm = std::hypot(axis[0] * 1e100, axis[1] * 1e100, axis[2] * 1e100);
      const long double radians = static_cast<long double>(Pi) / 180.0L * angle;
      const Vector unit{ axis[0] * 1e100L / norm, axis[1] * 1e100L / norm,
        axis[2] * 1e100L / norm };
      for (std::size_t i = 0; i < straight.Points.size(); ++i)
      {
        const Vector p = Subtract(straight.Points[i], { 0.0, 0.0, 0.0 });
        const Vector across = Cross(unit, p);
        const Vector towards = Cross(across, unit);
        for (int k = 0; k < 3; ++k)
        {
          const long double expected =
            Dot(unit, p) * unit[k] + std::cos(radians) * towards[k] + std::sin(radians) * across[k];
          EXPECT_NEAR(rotated.Points[i][k], static_cast<double>(expected),
            1e-15 * GetExtent(straight) * std::max(1.0, std::abs(angle) / 90.0));
        }
      }
    }
  }

  source->SetRotationAxis(0.0, 0.0, 2.0);
  source->SetRotationAngle(-270.0);
  const Boundary quarter = GetBoundary(source);
  for (std::size_t i = 0; i < straight.Points.size(); ++i)
  {
    const Point expected{ -straight.Points[i][1], straight.Points[i][0], straight.Points[i][2] };
    EXPECT_EQ(quarter.Points[i], expected);
  }
  source->SetRotationAngle(0.0);
}
} // namespace testing_devices

#endif
