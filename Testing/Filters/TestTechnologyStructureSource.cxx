// SPDX-License-Identifier: BSD-3-Clause
#include "DeviceBoundary.h"
#include "DeviceRegions.h"
#include "vtkConformingDelaunayMesher.h"
#include "vtkTechnologyStructureSource.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace testing_devices;

namespace
{
using Source = vtkTechnologyStructureSource;
using Changes = std::vector<std::function<void(Source*)>>;
using Check = std::function<void(Source*, const Boundary&)>;

/** Checks the default device with each of the changes; no two of them may make the same device. */
void CheckDevices(
  int structure, const Changes& changes, bool isRounded = false, const Check& check = nullptr)
{
  std::set<std::vector<Point>> different;
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    SCOPED_TRACE(i);
    vtkNew<Source> source;
    source->SetStructure(structure);
    changes[i](source);
    const Boundary boundary = GetBoundary(source);
    EXPECT_TRUE(different.insert(boundary.Points).second) << "the same device again";
    CheckBoundary(boundary, GetExpectedRegions(source), isRounded);
    if (check)
    {
      check(source, boundary);
    }
  }
}

/** Coordinates of these devices are sums of several lengths. The default one is also rotated. */
void CheckRounded(int structure, const Changes& changes)
{
  CheckDevices(structure, changes, true);
  vtkNew<Source> source;
  source->SetStructure(structure);
  CheckRotations(source, GetExpectedRegions(source));
}

TEST(TechnologyStructureSource, Locos)
{
  CheckRounded(Source::LOCOS,
    {
      [](Source*) {},
      [](Source* s) { s->SetProfileSegments(1); },
      [](Source* s) { s->SetProfileSegments(31); },
      [](Source* s) { s->SetPadOxideThickness(0.001); },
      [](Source* s) { s->SetStepLength(0.39); },
      [](Source* s) { s->SetFieldOxideThickness(1.1); },
    });
}

TEST(TechnologyStructureSource, DramInterconnect)
{
  CheckRounded(Source::DRAM_INTERCONNECT,
    {
      [](Source*) {},
      [](Source* s) { s->SetNumberOfWordLines(1); },
      [](Source* s) { s->SetNumberOfBitLines(1); },
      [](Source* s) { s->SetSidewallAngle(0.5); },
      [](Source* s)
      {
        s->SetNumberOfWordLines(3);
        s->SetNumberOfBitLines(3);
      },
      [](Source* s)
      {
        s->SetLinePitch(1.0);
        s->SetLineWidth(0.45);
        s->SetLineThickness(0.1);
        s->SetInsulatorThickness(0.05);
        s->SetSidewallAngle(30.0);
        s->SetNumberOfWordLines(2);
        s->SetNumberOfBitLines(4);
      },
    });
}

TEST(TechnologyStructureSource, TwoLayerInterconnect)
{
  CheckRounded(Source::TWO_LAYER_INTERCONNECT,
    {
      [](Source*) {},
      [](Source* s) { s->SetProfileSegments(1); },
      [](Source* s) { s->SetProfileSegments(45); },
      [](Source* s) { s->SetInsulatorThickness(0.01); },
      [](Source* s)
      {
        s->SetLinePitch(1.0 / 3.0);
        s->SetLineWidth(0.1);
        s->SetLineThickness(0.07);
        s->SetInsulatorThickness(1.0);
        s->SetBulkDepth(0.01);
        s->SetStepLength(0.1);
        s->SetProfileSegments(7);
      },
    });
}

TEST(TechnologyStructureSource, ViaWithBarrier)
{
  CheckRounded(Source::VIA_WITH_BARRIER,
    {
      [](Source*) {},
      [](Source* s)
      {
        s->SetNumberOfSegments(3);
        s->SetBarrierAsymmetry(0.4);
      },
      [](Source* s)
      {
        s->SetNumberOfSegments(90);
        s->SetBarrierAsymmetry(0.9);
      },
      [](Source* s) { s->SetBarrierThickness(0.001); },
      [](Source* s) { s->SetViaDiameter(0.999); },
    });
}

TEST(TechnologyStructureSource, Damascene)
{
  CheckRounded(Source::DAMASCENE,
    {
      [](Source*) {},
      [](Source* s) { s->SetNumberOfSegments(5); },
      [](Source* s) { s->SetBarrierAsymmetry(0.8); },
      [](Source* s) { s->SetTrenchWidth(0.361); },
    });
}

TEST(TechnologyStructureSource, CmosInverter)
{
  CheckRounded(Source::CMOS_INVERTER,
    {
      [](Source*) {},
      [](Source* s) { s->SetPassivationThickness(0.1); },
      [](Source* s) { s->SetSpacerSegments(1); },
      [](Source* s) { s->SetSpacerSegments(20); },
      [](Source* s) { s->SetContactWidth(0.01); },
      [](Source* s)
      {
        s->SetGateLength(0.1);
        s->SetGateHeight(0.13);
        s->SetGateOxideThickness(0.002);
        s->SetSpacerWidth(0.05);
        s->SetSpacerSegments(4);
        s->SetBulkDepth(1.0);
        s->SetChannelWidth(0.7);
        s->SetDiffusionLength(0.2);
        s->SetContactWidth(0.09);
        s->SetTrenchWidth(0.3);
        s->SetTrenchDepth(0.4);
        s->SetInsulatorThickness(0.1);
        s->SetLineThickness(0.15);
        s->SetPassivationThickness(0.2);
      },
    });
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
  for (int structure = Source::MOS_TRANSISTOR; structure <= Source::CMOS_INVERTER; ++structure)
  {
    for (const double angle : { 0.0, 33.0 })
    {
      vtkNew<Source> source;
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
      mesher->SetMeshForToFewestPoints();
      mesher->SetInputConnection(source->GetOutputPort());
      mesher->Update();
      auto* boundary = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
      ASSERT_GT(boundary->GetNumberOfCells(), 0);
      const std::vector<std::string> names = testing_filters::GetTexts(boundary, "ContactNames");
      ASSERT_FALSE(names.empty());
      const std::vector<std::string> regions =
        testing_filters::GetTexts(mesher->GetOutput(), "RegionNames");
      ASSERT_FALSE(regions.empty());
      // Files for simulators have one name space for both.
      std::set<std::string> different;
      for (const std::string& region : regions)
      {
        EXPECT_TRUE(different.insert(region).second) << region;
      }
      std::map<int, double> areas = GetContactAreas(boundary);
      for (const auto& [contact, area] : GetContactAreas(polygons))
      {
        EXPECT_NEAR(areas[contact], area, 1e-12);
      }
      EXPECT_EQ(areas.size(), names.size() + 1);
      for (std::size_t i = 0; i < names.size(); ++i)
      {
        EXPECT_GT(areas[static_cast<int>(i)], 0.0) << names[i];
        EXPECT_TRUE(different.insert(names[i]).second) << names[i];
      }
    }
  }
}

TEST(TechnologyStructureSource, NmosWithFieldOxideSweep)
{
  CheckDevices(Source::NMOS_WITH_FIELD_OXIDE,
    {
      [](Source*) {},
      [](Source* s) { s->SetGateOxideThickness(0.0005); },
      [](Source* s) { s->SetGateOxideThickness(0.05); },  // thicker than the cover
      [](Source* s) { s->SetCoverOxideThickness(0.08); }, // as thick as the field oxide is high
      // The gate's top is in the field oxide's cover.
      [](Source* s) { s->SetFieldOxideThickness(0.36); },
      [](Source* s) { s->SetDeviceWidth(0.60); },
      [](Source* s) { s->SetGateLength(0.03); },
      [](Source* s) { s->SetCoverOxideThickness(0.001); },
      [](Source* s) { s->SetBulkDepth(5.0); },
    });
}

TEST(TechnologyStructureSource, NmosWithFieldOxideRotated)
{
  vtkNew<Source> source;
  source->SetStructureToNmosWithFieldOxide();
  CheckRotations(source, GetExpectedRegions(source));
}

TEST(TechnologyStructureSource, DefaultIsTheMosTransistor)
{
  vtkNew<Source> untouched;
  EXPECT_STREQ(untouched->GetStructureAsString(), "MosTransistor");
  vtkNew<Source> source;
  source->SetStructureToMosTransistor();
  source->SetGateLength(0.18);
  source->SetGateHeight(0.2);
  source->SetGateOxideThickness(0.005);
  source->SetSpacerWidth(0.08);
  source->SetSpacerSegments(3);
  source->SetBulkLength(0.8);
  source->SetBulkDepth(0.5);
  source->SetDeviceWidth(0.3);
  const Boundary boundary = GetBoundary(untouched);
  CheckBoundary(boundary, GetExpectedRegions(source));
  EXPECT_EQ(boundary.Points, GetBoundary(source).Points);
}

TEST(TechnologyStructureSource, MosTransistorSweep)
{
  Changes changes;
  for (const double thickness : { 0.02, 0.01, 0.005, 0.001, 0.0005 })
  {
    changes.emplace_back([=](Source* s) { s->SetGateOxideThickness(thickness); });
  }
  for (const int segments : { 1, 2, 7, 90 })
  {
    changes.emplace_back([=](Source* s) { s->SetSpacerSegments(segments); });
  }
  changes.emplace_back(
    [](Source* s)
    {
      s->SetGateLength(0.013);
      s->SetGateHeight(0.05);
      s->SetGateOxideThickness(0.0003);
      s->SetSpacerWidth(0.007);
      s->SetSpacerSegments(4);
      s->SetBulkLength(0.0271);
      s->SetBulkDepth(2.0);
      s->SetDeviceWidth(10.0);
    });
  changes.emplace_back(
    [](Source* s)
    {
      s->SetGateLength(4.0);
      s->SetGateHeight(0.3);
      s->SetGateOxideThickness(0.1);
      s->SetSpacerWidth(0.2);
      s->SetSpacerSegments(1);
      s->SetBulkLength(1000.0);
      s->SetBulkDepth(500.0);
      s->SetDeviceWidth(1e-3);
    });
  changes.emplace_back(
    [](Source* s)
    {
      s->SetGateLength(1.0 / 3.0);
      s->SetGateHeight(1e-3);
      s->SetGateOxideThickness(1e-7);
      s->SetSpacerWidth(1e-3);
      s->SetSpacerSegments(5);
      s->SetBulkLength(0.4);
      s->SetBulkDepth(1e-3);
      s->SetDeviceWidth(1.0 / 7.0);
    });
  CheckDevices(Source::MOS_TRANSISTOR, changes, false,
    [](Source* source, const Boundary& boundary)
    {
      // No vertex and no polygon more than the device needs.
      const std::size_t segments = source->GetSpacerSegments();
      EXPECT_EQ(boundary.Points.size(), 20 + 4 * segments);
      EXPECT_EQ(boundary.Polygons.size(), 24 + 2 * segments);
      EXPECT_EQ(std::set<int>(boundary.FacetIds.begin(), boundary.FacetIds.end()).size(),
        boundary.Polygons.size());
    });
}

TEST(TechnologyStructureSource, MosTransistorRotated)
{
  for (const double thickness : { 0.005, 0.0005 })
  {
    vtkNew<Source> source;
    source->SetGateOxideThickness(thickness);
    CheckRotations(source, GetExpectedRegions(source));
  }
}

TEST(TechnologyStructureSource, ViaPlugSweep)
{
  Changes changes;
  for (const int segments : { 3, 4, 5, 6, 7, 8, 24, 61, 180 })
  {
    changes.emplace_back([=](Source* s) { s->SetNumberOfSegments(segments); });
  }
  changes.emplace_back(
    [](Source* s)
    {
      s->SetViaDiameter(0.1);
      s->SetViaHeight(3.0);
      s->SetNumberOfSegments(12);
      s->SetBottomLineWidth(0.1001);
      s->SetBottomLineThickness(0.05);
      s->SetTopLineWidth(5.0);
      s->SetTopLineThickness(0.7);
      s->SetBoxSize(5.0001);
    });
  changes.emplace_back(
    [](Source* s)
    {
      s->SetViaDiameter(0.02);
      s->SetViaHeight(0.001);
      s->SetNumberOfSegments(16);
      s->SetBottomLineWidth(0.9);
      s->SetBottomLineThickness(0.3);
      s->SetTopLineWidth(0.03);
      s->SetTopLineThickness(1e-4);
      s->SetBoxSize(1.0);
    });
  changes.emplace_back(
    [](Source* s)
    {
      s->SetViaDiameter(1.0 / 3.0);
      s->SetViaHeight(1e-3);
      s->SetNumberOfSegments(9);
      s->SetBottomLineWidth(0.5);
      s->SetBottomLineThickness(1.0);
      s->SetTopLineWidth(0.35);
      s->SetTopLineThickness(1e-3);
      s->SetBoxSize(2.0 / 3.0);
    });
  CheckDevices(Source::VIA_PLUG, changes, false,
    [](Source* source, const Boundary& boundary)
    {
      const std::size_t segments = source->GetNumberOfSegments();
      EXPECT_EQ(boundary.Points.size(), 28 + 2 * segments);
      EXPECT_EQ(boundary.Polygons.size(), 24 + segments);
      // The rings around the two ends of the plug are in two pieces.
      EXPECT_EQ(std::set<int>(boundary.FacetIds.begin(), boundary.FacetIds.end()).size(),
        boundary.Polygons.size() - 2);
    });
}

TEST(TechnologyStructureSource, ViaPlugRotated)
{
  vtkNew<Source> source;
  source->SetStructureToViaPlug();
  CheckRotations(source, GetExpectedRegions(source));
}

TEST(TechnologyStructureSource, ViaPlugFillsItsBox)
{
  vtkNew<Source> source;
  source->SetStructureToViaPlug();
  double volume = 0.0;
  for (const ExpectedRegion& region : GetExpectedRegions(source))
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

/** The closed forms are those of what the source keeps: no count may be clamped too early. */
TEST(TechnologyStructureSource, CountsReachTheEndsOfTheirRanges)
{
  vtkNew<Source> source;
  for (const int count : { 1, 90 })
  {
    source->SetSpacerSegments(count);
    source->SetProfileSegments(count);
    EXPECT_EQ(source->GetSpacerSegments(), count);
    EXPECT_EQ(source->GetProfileSegments(), count);
  }
  for (const int count : { 3, 720 })
  {
    source->SetNumberOfSegments(count);
    EXPECT_EQ(source->GetNumberOfSegments(), count);
  }
  for (const int count : { 1, 100 })
  {
    source->SetNumberOfWordLines(count);
    source->SetNumberOfBitLines(count);
    EXPECT_EQ(source->GetNumberOfWordLines(), count);
    EXPECT_EQ(source->GetNumberOfBitLines(), count);
  }
  source->SetBarrierAsymmetry(0.95);
  EXPECT_EQ(source->GetBarrierAsymmetry(), 0.95);
}

TEST(TechnologyStructureSource, ParametersOfTheOtherStructureDoNotMatter)
{
  vtkNew<Source> source;
  source->SetViaDiameter(-1.0);
  source->Update();
  EXPECT_GT(source->GetOutput()->GetNumberOfCells(), 0);
}
} // namespace
