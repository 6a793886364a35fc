// SPDX-License-Identifier: BSD-3-Clause
// The boundary of a device is judged by itself: closed regions, volumes in closed form, and no
// point where it does not belong, all by brute force.
#include "vtkConformingDelaunayMesher.h"
#include "vtkTechnologyStructureSource.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

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

/**
 * Each region is a closed manifold with the expected volume; the volumes add up. Rounded:
 * coordinates are turned, or sums of several lengths.
 */
void CheckRegions(
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

void CheckBoundary(
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

struct Locos
{
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
  double FieldOxideThickness = 0.16;
  double PadOxideThickness = 0.02;
  double NitrideThickness = 0.1;
  double StepLength = 0.1;
  int ProfileSegments = 6;
};

std::vector<ExpectedRegion> Apply(const Locos& locos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToLocos();
  source->SetBulkLength(locos.BulkLength);
  source->SetBulkDepth(locos.BulkDepth);
  source->SetDeviceWidth(locos.DeviceWidth);
  source->SetFieldOxideThickness(locos.FieldOxideThickness);
  source->SetPadOxideThickness(locos.PadOxideThickness);
  source->SetNitrideThickness(locos.NitrideThickness);
  source->SetStepLength(locos.StepLength);
  source->SetProfileSegments(locos.ProfileSegments);
  // Under the profile: trapezoids between the places where the cosine is taken, then a rectangle.
  std::vector<double> places;
  for (int i = 0; i <= locos.ProfileSegments; ++i)
  {
    places.push_back(locos.StepLength * (static_cast<double>(i) / locos.ProfileSegments - 1.0));
  }
  const int beyond = (locos.ProfileSegments + 1) / 2;
  for (int i = 1; i <= beyond; ++i)
  {
    places.push_back(0.5 * locos.StepLength * i / beyond);
  }
  const auto getProfile = [&](double x)
  { return 0.5 - 0.5 * std::cos(Pi * (x + locos.StepLength) / (1.5 * locos.StepLength)); };
  double profile = 0.5 * locos.BulkLength - places.back();
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    profile +=
      0.5 * (places[i] - places[i - 1]) * (getProfile(places[i - 1]) + getProfile(places[i]));
  }
  const double grown =
    (locos.FieldOxideThickness - locos.PadOxideThickness) * profile * locos.DeviceWidth;
  const double area = locos.BulkLength * locos.DeviceWidth;
  return { { "Bulk", area * locos.BulkDepth - 0.44 * grown, 2 },
    { "FieldOxide", area * locos.PadOxideThickness + grown, 2 },
    { "Nitride", 0.5 * area * locos.NitrideThickness, 2 } };
}

struct Dram
{
  double LinePitch = 0.4;
  double LineWidth = 0.16;
  double LineThickness = 0.2;
  double InsulatorThickness = 0.15;
  double SidewallAngle = 5.0;
  int NumberOfWordLines = 8;
  int NumberOfBitLines = 2;
};

std::vector<ExpectedRegion> Apply(const Dram& dram, vtkTechnologyStructureSource* source)
{
  source->SetStructureToDramInterconnect();
  source->SetLinePitch(dram.LinePitch);
  source->SetLineWidth(dram.LineWidth);
  source->SetLineThickness(dram.LineThickness);
  source->SetInsulatorThickness(dram.InsulatorThickness);
  source->SetSidewallAngle(dram.SidewallAngle);
  source->SetNumberOfWordLines(dram.NumberOfWordLines);
  source->SetNumberOfBitLines(dram.NumberOfBitLines);
  const double lengthX = dram.LinePitch * dram.NumberOfBitLines;
  const double lengthY = dram.LinePitch * dram.NumberOfWordLines;
  const double height = 3.0 * dram.InsulatorThickness + 2.0 * dram.LineThickness;
  // Trapezoids, and frustums of square pyramids.
  const double slope = std::tan(Pi / 180.0 * dram.SidewallAngle);
  const double section = dram.LineThickness * (dram.LineWidth - slope * dram.LineThickness);
  const double plugHeight = 2.0 * dram.InsulatorThickness + dram.LineThickness;
  const double narrow = dram.LineWidth - 2.0 * slope * dram.LineThickness;
  const double plug = plugHeight / 3.0 *
    (narrow * narrow + narrow * dram.LineWidth + dram.LineWidth * dram.LineWidth);
  std::vector<ExpectedRegion> regions{ { "Insulator", lengthX * lengthY * height, 2 } };
  for (int i = 1; i <= dram.NumberOfWordLines; ++i)
  {
    regions.push_back({ "WordLine" + std::to_string(i), section * lengthX, 2 });
  }
  int tunnels = dram.NumberOfWordLines + dram.NumberOfBitLines;
  for (int i = 1; i <= dram.NumberOfBitLines; ++i)
  {
    // Plugs in every other gap, beginning with the second and the first by turns.
    const int plugs = (dram.NumberOfWordLines - i % 2) / 2;
    regions.push_back({ "BitLine" + std::to_string(i), section * lengthY + plugs * plug, 2 });
    tunnels += plugs;
  }
  for (std::size_t i = 1; i < regions.size(); ++i)
  {
    regions[0].Volume -= regions[i].Volume;
  }
  regions[0].EulerCharacteristic -= 2 * tunnels;
  return regions;
}

struct TwoLayer
{
  double LinePitch = 0.4;
  double LineWidth = 0.16;
  double LineThickness = 0.2;
  double InsulatorThickness = 0.15;
  double BulkDepth = 0.5;
  double StepLength = 0.1;
  int ProfileSegments = 6;
};

std::vector<ExpectedRegion> Apply(const TwoLayer& lines, vtkTechnologyStructureSource* source)
{
  source->SetStructureToTwoLayerInterconnect();
  source->SetLinePitch(lines.LinePitch);
  source->SetLineWidth(lines.LineWidth);
  source->SetLineThickness(lines.LineThickness);
  source->SetInsulatorThickness(lines.InsulatorThickness);
  source->SetBulkDepth(lines.BulkDepth);
  source->SetStepLength(lines.StepLength);
  source->SetProfileSegments(lines.ProfileSegments);
  const double size = 2.0 * lines.LinePitch;
  const double line = lines.LineWidth * lines.LineThickness * size;
  // A step is symmetric to its middle: it has half of the area that a full step would have.
  const double oxide =
    size * size * lines.InsulatorThickness + 2.0 * size * lines.LineThickness * lines.StepLength;
  return { { "Bulk", size * size * lines.BulkDepth, 2 }, { "Oxide", oxide, 2 },
    { "LowerLine1", line, 2 }, { "LowerLine2", line, 2 }, { "UpperLine1", line, 2 },
    { "UpperLine2", line, 2 } };
}

struct LinedVia
{
  bool HasTrench = false;
  double ViaDiameter = 0.3;
  double ViaHeight = 0.6;
  int NumberOfSegments = 24;
  double BottomLineThickness = 0.3;
  double BarrierThickness = 0.03;
  double BarrierAsymmetry = 0.0;
  double GasHeight = 0.4;
  double BoxSize = 1.0;
  double TrenchWidth = 0.5;
  double TrenchDepth = 0.3;
};

std::vector<ExpectedRegion> Apply(const LinedVia& via, vtkTechnologyStructureSource* source)
{
  via.HasTrench ? source->SetStructureToDamascene() : source->SetStructureToViaWithBarrier();
  source->SetViaDiameter(via.ViaDiameter);
  source->SetViaHeight(via.ViaHeight);
  source->SetNumberOfSegments(via.NumberOfSegments);
  source->SetBottomLineThickness(via.BottomLineThickness);
  source->SetBarrierThickness(via.BarrierThickness);
  source->SetBarrierAsymmetry(via.BarrierAsymmetry);
  source->SetGasHeight(via.GasHeight);
  source->SetBoxSize(via.BoxSize);
  source->SetTrenchWidth(via.TrenchWidth);
  source->SetTrenchDepth(via.TrenchDepth);
  const auto getArea = [&](double diameter)
  {
    return 0.125 * diameter * diameter * via.NumberOfSegments *
      std::sin(2.0 * Pi / via.NumberOfSegments);
  };
  const double area = via.BoxSize * via.BoxSize;
  const double depth = via.HasTrench ? via.TrenchDepth : 0.0;
  const double insulator = area * (via.ViaHeight + depth) -
    getArea(via.ViaDiameter) * via.ViaHeight - via.TrenchWidth * via.BoxSize * depth;
  // The hole that the barrier leaves is as deep as the via, the trench as deep as it was.
  const double open = getArea(via.ViaDiameter - 2.0 * via.BarrierThickness) * via.ViaHeight +
    (via.TrenchWidth - 2.0 * via.BarrierThickness) * via.BoxSize * depth;
  return { { "Insulator", insulator, 0 }, { "BottomMetal", area * via.BottomLineThickness, 2 },
    { "Barrier", area * (via.ViaHeight + depth + via.BarrierThickness) - insulator - open, 2 },
    { "Gas", open + area * via.GasHeight, 2 } };
}

struct Cmos
{
  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double SpacerWidth = 0.08;
  int SpacerSegments = 3;
  double BulkDepth = 0.5;
  double ChannelWidth = 0.18;
  double DiffusionLength = 0.3;
  double ContactWidth = 0.12;
  double TrenchWidth = 0.5;
  double TrenchDepth = 0.3;
  double InsulatorThickness = 0.15;
  double LineThickness = 0.2;
  double PassivationThickness = 0.0;
};

std::vector<ExpectedRegion> Apply(const Cmos& cmos, vtkTechnologyStructureSource* source)
{
  source->SetStructureToCmosInverter();
  source->SetGateLength(cmos.GateLength);
  source->SetGateHeight(cmos.GateHeight);
  source->SetGateOxideThickness(cmos.GateOxideThickness);
  source->SetSpacerWidth(cmos.SpacerWidth);
  source->SetSpacerSegments(cmos.SpacerSegments);
  source->SetBulkDepth(cmos.BulkDepth);
  source->SetChannelWidth(cmos.ChannelWidth);
  source->SetDiffusionLength(cmos.DiffusionLength);
  source->SetContactWidth(cmos.ContactWidth);
  source->SetTrenchWidth(cmos.TrenchWidth);
  source->SetTrenchDepth(cmos.TrenchDepth);
  source->SetInsulatorThickness(cmos.InsulatorThickness);
  source->SetLineThickness(cmos.LineThickness);
  source->SetPassivationThickness(cmos.PassivationThickness);
  const double contact = cmos.ContactWidth;
  const double activeLength = cmos.GateLength + 2.0 * (cmos.SpacerWidth + cmos.DiffusionLength);
  const double length = activeLength + 2.0 * cmos.TrenchWidth;
  const double width = 2.0 * (cmos.TrenchWidth + cmos.ChannelWidth) + 5.0 * contact;
  const double active = 2.0 * activeLength * cmos.ChannelWidth;
  // Gates end in the middle of the outer trench, and two contacts beyond the channel.
  const double gateWidth = 0.5 * cmos.TrenchWidth + cmos.ChannelWidth + 2.0 * contact;
  const double gate = cmos.GateLength * cmos.GateHeight * gateWidth;
  const double spacer = cmos.SpacerWidth * cmos.GateHeight * gateWidth * 0.5 * cmos.SpacerSegments *
    std::sin(0.5 * Pi / cmos.SpacerSegments);
  const double plug =
    contact * contact * (cmos.GateOxideThickness + cmos.GateHeight + cmos.InsulatorThickness);
  const double section = contact * cmos.LineThickness;
  // From the edge of the device over the trench to the far side of the contact.
  const double supply =
    plug + section * (cmos.TrenchWidth + 0.5 * cmos.DiffusionLength + 0.5 * contact);
  const double silicon =
    length * width * (cmos.BulkDepth - cmos.TrenchDepth) + active * cmos.TrenchDepth;
  const double oxide = (length * width - active) * cmos.TrenchDepth +
    (length * width - 4.0 * contact * contact) * cmos.GateOxideThickness;
  std::vector<ExpectedRegion> regions{ { "Silicon", silicon, 2 }, { "Oxide", oxide, -6 },
    { "NmosGate", gate, 2 }, { "PmosGate", gate, 2 }, { "NmosSourceSpacer", spacer, 2 },
    { "NmosDrainSpacer", spacer, 2 }, { "PmosSourceSpacer", spacer, 2 },
    { "PmosDrainSpacer", spacer, 2 }, { "Ground", supply, 2 }, { "Supply", supply, 2 },
    { "Input", 2.0 * contact * contact * cmos.InsulatorThickness + 4.0 * contact * section, 2 },
    { "Output", 2.0 * plug + (cmos.ChannelWidth + 6.0 * contact) * section, 2 } };
  if (cmos.PassivationThickness > 0.0)
  {
    double rest = length * width *
      (cmos.BulkDepth + cmos.GateOxideThickness + cmos.GateHeight + cmos.InsulatorThickness +
        cmos.LineThickness + cmos.PassivationThickness);
    for (const ExpectedRegion& region : regions)
    {
      rest -= region.Volume;
    }
    // A tunnel under each of the four metal lines.
    regions.push_back({ "Passivation", rest, -6 });
  }
  return regions;
}

template <typename Parameters>
void CheckRounded(const std::vector<Parameters>& devices)
{
  for (std::size_t i = 0; i < devices.size(); ++i)
  {
    SCOPED_TRACE(i);
    vtkNew<vtkTechnologyStructureSource> source;
    const std::vector<ExpectedRegion> regions = Apply(devices[i], source);
    const Boundary straight = GetBoundary(source);
    CheckBoundary(straight, regions, true);
    if (i == 0)
    {
      CheckRotations(source, straight, regions);
    }
  }
}

TEST(TechnologyStructureSource, Locos)
{
  std::vector<Locos> devices(6);
  devices[1].ProfileSegments = 1;
  devices[2].ProfileSegments = 31;
  devices[3].PadOxideThickness = 0.001;
  devices[4].StepLength = 0.39;
  devices[5].FieldOxideThickness = 1.1;
  CheckRounded(devices);
}

TEST(TechnologyStructureSource, DramInterconnect)
{
  std::vector<Dram> devices(6);
  devices[1].NumberOfWordLines = 1;
  devices[2].NumberOfBitLines = 1;
  devices[3].SidewallAngle = 0.5;
  devices[4].NumberOfWordLines = 3;
  devices[4].NumberOfBitLines = 3;
  devices[5] = { 1.0, 0.45, 0.1, 0.05, 30.0, 2, 4 };
  CheckRounded(devices);
}

TEST(TechnologyStructureSource, TwoLayerInterconnect)
{
  std::vector<TwoLayer> devices(5);
  devices[1].ProfileSegments = 1;
  devices[2].ProfileSegments = 45;
  devices[3].InsulatorThickness = 0.01;
  devices[4] = { 1.0 / 3.0, 0.1, 0.07, 1.0, 0.01, 0.1, 7 };
  CheckRounded(devices);
}

TEST(TechnologyStructureSource, ViaWithBarrier)
{
  std::vector<LinedVia> devices(5);
  devices[1].NumberOfSegments = 3;
  devices[1].BarrierAsymmetry = 0.4;
  devices[2].NumberOfSegments = 90;
  devices[2].BarrierAsymmetry = 0.9;
  devices[3].BarrierThickness = 0.001;
  devices[4].ViaDiameter = 0.999;
  CheckRounded(devices);
}

TEST(TechnologyStructureSource, Damascene)
{
  std::vector<LinedVia> devices(4);
  devices[1].NumberOfSegments = 5;
  devices[2].BarrierAsymmetry = 0.8;
  devices[3].TrenchWidth = 0.361;
  for (LinedVia& via : devices)
  {
    via.HasTrench = true;
  }
  CheckRounded(devices);
}

TEST(TechnologyStructureSource, CmosInverter)
{
  std::vector<Cmos> devices(6);
  devices[1].PassivationThickness = 0.1;
  devices[2].SpacerSegments = 1;
  devices[3].SpacerSegments = 20;
  devices[4].ContactWidth = 0.01;
  devices[5] = { 0.1, 0.13, 0.002, 0.05, 4, 1.0, 0.7, 0.2, 0.09, 0.3, 0.4, 0.1, 0.15, 0.2 };
  CheckRounded(devices);
}

std::map<int, double> GetContactAreas(vtkPolyData* surface)
{
  std::map<int, double> areas;
  vtkDataArray* ids = surface->GetCellData()->GetArray("ContactId");
  for (vtkIdType i = 0; i < surface->GetNumberOfCells(); ++i)
  {
    double normal[3];
    vtkCell* cell = surface->GetCell(i);
    const double area =
      vtkPolygon::ComputeArea(cell->GetPoints(), cell->GetNumberOfPoints(), nullptr, normal);
    areas[static_cast<int>(ids->GetComponent(i, 0))] += area;
  }
  return areas;
}

/** Contacts are whole facets, and come out of the mesher with their names and areas. */
TEST(TechnologyStructureSource, ContactsReachTheBoundaryOfTheMesh)
{
  for (int structure = vtkTechnologyStructureSource::MOS_TRANSISTOR;
       structure <= vtkTechnologyStructureSource::CMOS_INVERTER; ++structure)
  {
    for (const double angle : { 0.0, 33.0 })
    {
      vtkNew<vtkTechnologyStructureSource> source;
      source->SetStructure(structure);
      source->SetRotationAngle(angle);
      source->SetRotationAxis(1.0, 2.0, 3.0);
      source->Update();
      SCOPED_TRACE(source->GetStructureAsString());
      vtkPolyData* polygons = source->GetOutput();
      vtkDataArray* ids = polygons->GetCellData()->GetArray("ContactId");
      vtkDataArray* facets = polygons->GetCellData()->GetArray("FacetId");
      std::map<double, double> contactOfFacet;
      for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
      {
        const double contact = ids->GetComponent(i, 0);
        EXPECT_EQ(
          contactOfFacet.emplace(facets->GetComponent(i, 0), contact).first->second, contact);
      }
      vtkNew<vtkConformingDelaunayMesher> mesher;
      mesher->SetInputConnection(source->GetOutputPort());
      mesher->Update();
      auto* boundary = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
      ASSERT_GT(boundary->GetNumberOfCells(), 0);
      auto* names =
        vtkStringArray::SafeDownCast(boundary->GetFieldData()->GetAbstractArray("ContactNames"));
      ASSERT_NE(names, nullptr);
      auto* regions = vtkStringArray::SafeDownCast(
        mesher->GetOutput()->GetFieldData()->GetAbstractArray("RegionNames"));
      ASSERT_NE(regions, nullptr);
      // Files for simulators have one name space for both.
      std::set<std::string> different;
      for (vtkIdType i = 0; i < regions->GetNumberOfValues(); ++i)
      {
        EXPECT_TRUE(different.insert(regions->GetValue(i)).second) << regions->GetValue(i);
      }
      std::map<int, double> areas = GetContactAreas(boundary);
      for (const auto& [contact, area] : GetContactAreas(polygons))
      {
        EXPECT_NEAR(areas[contact], area, 1e-12);
      }
      EXPECT_EQ(static_cast<vtkIdType>(areas.size()), names->GetNumberOfValues() + 1);
      for (vtkIdType i = 0; i < names->GetNumberOfValues(); ++i)
      {
        EXPECT_GT(areas[static_cast<int>(i)], 0.0) << names->GetValue(i);
        EXPECT_TRUE(different.insert(names->GetValue(i)).second) << names->GetValue(i);
      }
    }
  }
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

TEST(TechnologyStructureSource, ErrorsOfInterconnectsAndInverter)
{
  using Source = vtkTechnologyStructureSource;
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToLocos();
      s->SetPadOxideThickness(0.2);
    },
    { "PadOxideThickness = 0.2", "FieldOxideThickness = 0.16" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToLocos();
      s->SetStepLength(0.4);
    },
    { "2 StepLength = 0.8", "BulkLength = 0.8" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToDramInterconnect();
      s->SetSidewallAngle(22.0);
    },
    { "SidewallAngle", "LineWidth = 0.16" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToDramInterconnect();
      s->SetSidewallAngle(std::nan(""));
    },
    { "SidewallAngle", "0.1 to 45" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToDramInterconnect();
      s->SetLinePitch(0.3);
    },
    { "2 LineWidth = 0.32", "LinePitch = 0.3" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToTwoLayerInterconnect();
      s->SetStepLength(0.12);
    },
    { "LineWidth + 2 StepLength = 0.4", "LinePitch = 0.4" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToViaWithBarrier();
      s->SetBarrierThickness(0.15);
    },
    { "2 BarrierThickness", "ViaDiameter = 0.3" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToViaWithBarrier();
      s->SetNumberOfSegments(3);
      s->SetBarrierAsymmetry(0.6);
    },
    { "BarrierAsymmetry = 0.6", "NumberOfSegments" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToDamascene();
      s->SetTrenchWidth(0.3);
    },
    { "ViaDiameter + 2 BarrierThickness = 0.36", "TrenchWidth = 0.3" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToCmosInverter();
      s->SetContactWidth(0.2);
    },
    { "ContactWidth = 0.2", "GateLength = 0.18" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToCmosInverter();
      s->SetTrenchDepth(0.5);
    },
    { "TrenchDepth = 0.5", "BulkDepth = 0.5" });
  ExpectError(
    [](Source* s)
    {
      s->SetStructureToCmosInverter();
      s->SetPassivationThickness(-1.0);
    },
    { "PassivationThickness = -1" });
}

TEST(TechnologyStructureSource, ParametersOfTheOtherStructureDoNotMatter)
{
  vtkNew<vtkTechnologyStructureSource> source;
  source->SetViaDiameter(-1.0);
  source->Update();
  EXPECT_GT(source->GetOutput()->GetNumberOfCells(), 0);
}
} // namespace
