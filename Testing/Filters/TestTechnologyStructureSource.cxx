// SPDX-License-Identifier: BSD-3-Clause
// The boundary of a device is judged by itself: closed regions, volumes in closed form, and no
// point where it does not belong, all by brute force.
#include "vtkTechnologyStructureSource.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace
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

Boundary GetBoundary(vtkTechnologyStructureSource* source)
{
  source->Update();
  vtkPolyData* output = source->GetOutput();
  Boundary boundary;
  auto* labels = vtkIntArray::SafeDownCast(output->GetCellData()->GetArray("BoundaryLabels"));
  auto* facets = vtkIntArray::SafeDownCast(output->GetCellData()->GetArray("FacetId"));
  auto* names =
    vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("RegionNames"));
  if (!labels || !facets || !names)
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
  for (vtkIdType i = 0; i < names->GetNumberOfValues(); ++i)
  {
    boundary.RegionNames.push_back(names->GetValue(i));
  }
  return boundary;
}

Vector Subtract(const Point& a, const Point& b)
{
  return { static_cast<long double>(a[0]) - b[0], static_cast<long double>(a[1]) - b[1],
    static_cast<long double>(a[2]) - b[2] };
}

Vector Cross(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

long double Dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

long double Norm(const Vector& a)
{
  return std::sqrt(Dot(a, a));
}

/** Area times normal. */
Vector GetAreaVector(const Boundary& boundary, const Loop& loop)
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
std::vector<Loop> GetRegionBoundary(const Boundary& boundary, int region)
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
long double GetVolume(const Boundary& boundary, const std::vector<Loop>& loops)
{
  const Point& origin = boundary.Points[loops[0][0]];
  long double volume = 0.0L;
  for (const Loop& loop : loops)
  {
    volume += Dot(Subtract(boundary.Points[loop[0]], origin), GetAreaVector(boundary, loop)) / 3.0L;
  }
  return volume;
}

double GetExtent(const Boundary& boundary)
{
  double extent = 0.0;
  for (const Point& point : boundary.Points)
  {
    extent = std::max(extent, std::hypot(point[0], point[1], point[2]));
  }
  return extent;
}

double GetDistanceToSegment(const Point& p, const Point& a, const Point& b)
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
bool IsInside(const Boundary& boundary, const Loop& loop, const Vector& normal, const Point& p)
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

void CheckPoints(const Boundary& boundary)
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

void CheckPolygons(const Boundary& boundary, const std::vector<ExpectedRegion>& regions)
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
void CheckNoTJunctions(const Boundary& boundary)
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

/** Each region is a closed manifold with the expected volume; the volumes add up. */
void CheckRegions(
  const Boundary& boundary, const std::vector<ExpectedRegion>& regions, bool isRotated)
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

    // A rotated point is off by a few roundings, which moves the whole surface by as much.
    const long double allowed = isRotated
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
void CheckExactlyPlanar(const Boundary& boundary)
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

void CheckBoundary(const Boundary& boundary, const std::vector<ExpectedRegion>& regions)
{
  ASSERT_FALSE(boundary.Polygons.empty());
  CheckPoints(boundary);
  CheckPolygons(boundary, regions);
  CheckNoTJunctions(boundary);
  CheckRegions(boundary, regions, false);
  CheckExactlyPlanar(boundary);
}

/** Rotated, a device has the same polygons; only the coordinates differ. */
void CheckRotations(vtkTechnologyStructureSource* source, const Boundary& straight,
  const std::vector<ExpectedRegion>& regions)
{
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

  const double z[3] = { 0.0, 0.0, 2.0 };
  source->SetRotationAxis(z);
  source->SetRotationAngle(-270.0);
  const Boundary quarter = GetBoundary(source);
  for (std::size_t i = 0; i < straight.Points.size(); ++i)
  {
    const Point expected{ -straight.Points[i][1], straight.Points[i][0], straight.Points[i][2] };
    EXPECT_EQ(quarter.Points[i], expected);
  }
  source->SetRotationAngle(0.0);
}

struct Mos
{
  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double SpacerWidth = 0.08;
  int SpacerSegments = 3;
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
};

std::vector<ExpectedRegion> Apply(const Mos& mos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToMosTransistor();
  source->SetGateLength(mos.GateLength);
  source->SetGateHeight(mos.GateHeight);
  source->SetGateOxideThickness(mos.GateOxideThickness);
  source->SetSpacerWidth(mos.SpacerWidth);
  source->SetSpacerSegments(mos.SpacerSegments);
  source->SetBulkLength(mos.BulkLength);
  source->SetBulkDepth(mos.BulkDepth);
  source->SetDeviceWidth(mos.DeviceWidth);
  // Triangles with equal angles at the centre of an ellipse have equal areas.
  const double spacer = mos.SpacerWidth * mos.GateHeight * mos.DeviceWidth * 0.5 *
    mos.SpacerSegments * std::sin(0.5 * Pi / mos.SpacerSegments);
  return { { "Bulk", mos.BulkLength * mos.BulkDepth * mos.DeviceWidth, 2 },
    { "GateOxide",
      (mos.GateLength + 2.0 * mos.SpacerWidth) * mos.GateOxideThickness * mos.DeviceWidth, 2 },
    { "Gate", mos.GateLength * mos.GateHeight * mos.DeviceWidth, 2 }, { "LeftSpacer", spacer, 2 },
    { "RightSpacer", spacer, 2 } };
}

struct Via
{
  double ViaDiameter = 0.3;
  double ViaHeight = 0.6;
  int NumberOfSegments = 24;
  double BottomLineWidth = 0.4;
  double BottomLineThickness = 0.3;
  double TopLineWidth = 0.4;
  double TopLineThickness = 0.3;
  double BoxSize = 1.0;
};

std::vector<ExpectedRegion> Apply(const Via& via, vtkTechnologyStructureSource* source)
{
  source->SetStructureToViaPlug();
  source->SetViaDiameter(via.ViaDiameter);
  source->SetViaHeight(via.ViaHeight);
  source->SetNumberOfSegments(via.NumberOfSegments);
  source->SetBottomLineWidth(via.BottomLineWidth);
  source->SetBottomLineThickness(via.BottomLineThickness);
  source->SetTopLineWidth(via.TopLineWidth);
  source->SetTopLineThickness(via.TopLineThickness);
  source->SetBoxSize(via.BoxSize);
  const double plug = 0.125 * via.ViaDiameter * via.ViaDiameter * via.NumberOfSegments *
    std::sin(2.0 * Pi / via.NumberOfSegments);
  const double insulator =
    via.BottomLineThickness * via.BoxSize * (via.BoxSize - via.BottomLineWidth) +
    via.ViaHeight * (via.BoxSize * via.BoxSize - plug) +
    via.TopLineThickness * via.BoxSize * (via.BoxSize - via.TopLineWidth);
  return { { "Insulator", insulator, 0 },
    { "BottomLine", via.BottomLineThickness * via.BoxSize * via.BottomLineWidth, 2 },
    { "Plug", plug * via.ViaHeight, 2 },
    { "TopLine", via.TopLineThickness * via.BoxSize * via.TopLineWidth, 2 } };
}

struct Nmos
{
  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
  double ChannelWidth = 0.18;
  double FieldOxideThickness = 0.16;
  double CoverOxideThickness = 0.03;
};

std::vector<ExpectedRegion> Apply(const Nmos& nmos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToNmosWithFieldOxide();
  source->SetGateLength(nmos.GateLength);
  source->SetGateHeight(nmos.GateHeight);
  source->SetGateOxideThickness(nmos.GateOxideThickness);
  source->SetBulkLength(nmos.BulkLength);
  source->SetBulkDepth(nmos.BulkDepth);
  source->SetDeviceWidth(nmos.DeviceWidth);
  source->SetChannelWidth(nmos.ChannelWidth);
  source->SetFieldOxideThickness(nmos.FieldOxideThickness);
  source->SetCoverOxideThickness(nmos.CoverOxideThickness);
  const double width = nmos.DeviceWidth - nmos.ChannelWidth;
  const double field = 0.5 * nmos.FieldOxideThickness;
  const double cover = nmos.CoverOxideThickness;
  const double gateTop = nmos.GateOxideThickness + nmos.GateHeight;
  // The cover on the gate, on its two flanks, and on the field oxide and the silicon beside them.
  const double onGate = nmos.GateLength * nmos.DeviceWidth * cover;
  const double onFlanks =
    2.0 * cover * (nmos.ChannelWidth * (gateTop + cover) + width * (gateTop + cover - field));
  const double beside = (nmos.BulkLength - nmos.GateLength - 2.0 * cover) *
    (width * cover + 2.0 * cover * (field + cover) + (nmos.ChannelWidth - 2.0 * cover) * cover);
  const double oxide = nmos.GateLength * nmos.ChannelWidth * nmos.GateOxideThickness;
  return {
    { "Bulk",
      nmos.BulkLength * (nmos.ChannelWidth * nmos.BulkDepth + width * (nmos.BulkDepth - field)),
      2 },
    { "LeftFieldOxide", nmos.BulkLength * 0.5 * width * nmos.FieldOxideThickness, 2 },
    { "RightFieldOxide", nmos.BulkLength * 0.5 * width * nmos.FieldOxideThickness, 2 },
    { "GateOxide", oxide, 2 },
    { "Gate", nmos.GateLength * (nmos.ChannelWidth * nmos.GateHeight + width * (gateTop - field)),
      2 },
    { "CoverOxide", onGate + onFlanks + beside, 2 },
  };
}
TEST(TechnologyStructureSource, NmosWithFieldOxideSweep)
{
  std::vector<Nmos> devices(9);
  devices[1].GateOxideThickness = 0.0005;
  devices[2].GateOxideThickness = 0.05;  // thicker than the cover
  devices[3].CoverOxideThickness = 0.08; // as thick as the field oxide is high
  devices[4].FieldOxideThickness = 0.36; // the gate's top is in the field oxide's cover
  devices[5].DeviceWidth = 0.60;
  devices[6].GateLength = 0.03;
  devices[7].CoverOxideThickness = 0.001;
  devices[8].BulkDepth = 5.0;
  for (const Nmos& nmos : devices)
  {
    SCOPED_TRACE(nmos.GateOxideThickness);
    SCOPED_TRACE(nmos.CoverOxideThickness);
    SCOPED_TRACE(nmos.FieldOxideThickness);
    vtkNew<vtkTechnologyStructureSource> source;
    const std::vector<ExpectedRegion> regions = Apply(nmos, source);
    CheckBoundary(GetBoundary(source), regions);
  }
}

TEST(TechnologyStructureSource, NmosWithFieldOxideRotated)
{
  vtkNew<vtkTechnologyStructureSource> source;
  const std::vector<ExpectedRegion> regions = Apply(Nmos{}, source);
  CheckRotations(source, GetBoundary(source), regions);
}

TEST(TechnologyStructureSource, DefaultIsTheMosTransistor)
{
  vtkNew<vtkTechnologyStructureSource> untouched;
  EXPECT_STREQ(untouched->GetStructureAsString(), "MosTransistor");
  vtkNew<vtkTechnologyStructureSource> source;
  const std::vector<ExpectedRegion> regions = Apply(Mos{}, source);
  const Boundary boundary = GetBoundary(untouched);
  CheckBoundary(boundary, regions);
  EXPECT_EQ(boundary.Points, GetBoundary(source).Points);
}

TEST(TechnologyStructureSource, MosTransistorSweep)
{
  std::vector<Mos> devices;
  for (const double thickness : { 0.02, 0.01, 0.005, 0.001, 0.0005 })
  {
    devices.emplace_back().GateOxideThickness = thickness;
  }
  for (const int segments : { 1, 2, 7, 90 })
  {
    devices.emplace_back().SpacerSegments = segments;
  }
  devices.push_back({ 0.013, 0.05, 0.0003, 0.007, 4, 0.0271, 2.0, 10.0 });
  devices.push_back({ 4.0, 0.3, 0.1, 0.2, 1, 1000.0, 500.0, 1e-3 });
  devices.push_back({ 1.0 / 3.0, 1e-3, 1e-7, 1e-3, 5, 0.4, 1e-3, 1.0 / 7.0 });
  for (const Mos& mos : devices)
  {
    SCOPED_TRACE(mos.GateOxideThickness);
    SCOPED_TRACE(mos.SpacerSegments);
    vtkNew<vtkTechnologyStructureSource> source;
    const std::vector<ExpectedRegion> regions = Apply(mos, source);
    const Boundary boundary = GetBoundary(source);
    CheckBoundary(boundary, regions);
    // No vertex and no polygon more than the device needs.
    const std::size_t segments = mos.SpacerSegments;
    EXPECT_EQ(boundary.Points.size(), 20 + 4 * segments);
    EXPECT_EQ(boundary.Polygons.size(), 24 + 2 * segments);
    EXPECT_EQ(std::set<int>(boundary.FacetIds.begin(), boundary.FacetIds.end()).size(),
      boundary.Polygons.size());
  }
}

TEST(TechnologyStructureSource, MosTransistorRotated)
{
  for (const double thickness : { 0.005, 0.0005 })
  {
    Mos mos;
    mos.GateOxideThickness = thickness;
    vtkNew<vtkTechnologyStructureSource> source;
    const std::vector<ExpectedRegion> regions = Apply(mos, source);
    CheckRotations(source, GetBoundary(source), regions);
  }
}

TEST(TechnologyStructureSource, ViaPlugSweep)
{
  std::vector<Via> devices;
  for (const int segments : { 3, 4, 5, 6, 7, 8, 24, 61, 180 })
  {
    devices.emplace_back().NumberOfSegments = segments;
  }
  devices.push_back({ 0.1, 3.0, 12, 0.1001, 0.05, 5.0, 0.7, 5.0001 });
  devices.push_back({ 0.02, 0.001, 16, 0.9, 0.3, 0.03, 1e-4, 1.0 });
  devices.push_back({ 1.0 / 3.0, 1e-3, 9, 0.5, 1.0, 0.35, 1e-3, 2.0 / 3.0 });
  for (const Via& via : devices)
  {
    SCOPED_TRACE(via.NumberOfSegments);
    SCOPED_TRACE(via.ViaHeight);
    vtkNew<vtkTechnologyStructureSource> source;
    const std::vector<ExpectedRegion> regions = Apply(via, source);
    const Boundary boundary = GetBoundary(source);
    CheckBoundary(boundary, regions);
    const std::size_t segments = via.NumberOfSegments;
    EXPECT_EQ(boundary.Points.size(), 28 + 2 * segments);
    EXPECT_EQ(boundary.Polygons.size(), 24 + segments);
    // The rings around the two ends of the plug are in two pieces.
    EXPECT_EQ(std::set<int>(boundary.FacetIds.begin(), boundary.FacetIds.end()).size(),
      boundary.Polygons.size() - 2);
  }
}

TEST(TechnologyStructureSource, ViaPlugRotated)
{
  vtkNew<vtkTechnologyStructureSource> source;
  const std::vector<ExpectedRegion> regions = Apply(Via{}, source);
  CheckRotations(source, GetBoundary(source), regions);
}

TEST(TechnologyStructureSource, ViaPlugFillsItsBox)
{
  vtkNew<vtkTechnologyStructureSource> source;
  double volume = 0.0;
  for (const ExpectedRegion& region : Apply(Via{}, source))
  {
    volume += region.Volume;
  }
  EXPECT_NEAR(volume, 1.2, 1e-14);
  double bounds[6];
  source->Update();
  source->GetOutput()->GetBounds(bounds);
  EXPECT_EQ((std::array<double, 4>{ bounds[0], bounds[1], bounds[2], bounds[3] }),
    (std::array<double, 4>{ -0.5, 0.5, -0.5, 0.5 }));
  EXPECT_EQ(bounds[4], -0.3);
  EXPECT_EQ(bounds[5], 0.6 + 0.3);
}

/** Runs the source, which has to fail with a message that contains all of the words. */
void ExpectError(const std::function<void(vtkTechnologyStructureSource*)>& change,
  const std::vector<std::string>& words)
{
  vtkNew<vtkTechnologyStructureSource> source;
  std::string message;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&message);
  listener->SetCallback([](vtkObject*, unsigned long, void* clientData, void* callData)
    { *static_cast<std::string*>(clientData) += static_cast<const char*>(callData); });
  source->AddObserver(vtkCommand::ErrorEvent, listener);
  source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listener);
  // A good result before must not survive the failure.
  source->Update();
  EXPECT_EQ(message, "");
  change(source);
  source->Update();
  for (const std::string& word : words)
  {
    EXPECT_NE(message.find(word), std::string::npos) << word << " is missing in: " << message;
  }
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(source->GetOutput()->GetNumberOfCells(), 0);
}

TEST(TechnologyStructureSource, ErrorsNameTheParameters)
{
  using Source = vtkTechnologyStructureSource;
  ExpectError([](Source* s) { s->SetGateOxideThickness(0.0); }, { "GateOxideThickness = 0" });
  ExpectError([](Source* s) { s->SetGateHeight(-1.0); }, { "GateHeight = -1" });
  ExpectError([](Source* s) { s->SetDeviceWidth(std::nan("")); }, { "DeviceWidth" });
  ExpectError([](Source* s) { s->SetBulkDepth(VTK_DOUBLE_MAX); }, { "BulkDepth" });
  ExpectError([](Source* s) { s->SetBulkLength(0.3); },
    { "GateLength + 2 SpacerWidth = 0.34", "BulkLength = 0.3" });
  ExpectError([](Source* s) { s->SetBulkLength(0.18 + 2.0 * 0.08); }, { "below", "BulkLength" });
  ExpectError(
    [](Source* s)
    {
      s->SetGateHeight(1e-9);
      s->SetGateOxideThickness(1e9);
    },
    { "GateOxideThickness and GateHeight", "double precision" });
  ExpectError(
    [](Source* s)
    {
      s->SetBulkLength(1e9);
      s->SetGateLength(1e8);
      s->SetSpacerWidth(1e-9);
    },
    { "SpacerWidth", "double precision" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToViaPlug();
      s->SetViaDiameter(0.4);
    },
    { "ViaDiameter = 0.4", "BottomLineWidth = 0.4" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToViaPlug();
      s->SetTopLineWidth(1.5);
    },
    { "TopLineWidth = 1.5", "BoxSize = 1" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToViaPlug();
      s->SetViaHeight(1e9);
      s->SetTopLineThickness(1e-9);
    },
    { "ViaHeight", "TopLineThickness" });
  ExpectError(
    [](Source* s)
    {
      s->SetRotationAngle(30.0);
      s->SetRotationAxis(0.0, 0.0, 0.0);
    },
    { "RotationAxis" });
  ExpectError([](Source* s) { s->SetRotationAngle(std::nan("")); }, { "RotationAngle" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToNmosWithFieldOxide();
      s->SetDeviceWidth(0.18);
    },
    { "ChannelWidth = 0.18", "DeviceWidth = 0.18" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToNmosWithFieldOxide();
      s->SetFieldOxideThickness(0.5);
    },
    { "FieldOxideThickness / 2 = 0.25", "GateOxideThickness + GateHeight = 0.205" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToNmosWithFieldOxide();
      s->SetCoverOxideThickness(0.09);
    },
    { "2 CoverOxideThickness", "ChannelWidth = 0.18" });
}

TEST(TechnologyStructureSource, ParametersOfTheOtherStructureDoNotMatter)
{
  vtkNew<vtkTechnologyStructureSource> source;
  source->SetViaDiameter(-1.0);
  source->Update();
  EXPECT_GT(source->GetOutput()->GetNumberOfCells(), 0);
}
} // namespace
