// SPDX-License-Identifier: BSD-3-Clause
#include "DeviceBoundary.h"
#include "DeviceParameters.h"
#include "vtkConformingDelaunayMesher.h"
#include "vtkTechnologyStructureSource.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace testing_devices;

namespace
{
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

TEST(TechnologyStructureSource, ParametersOfTheOtherStructureDoNotMatter)
{
  vtkNew<vtkTechnologyStructureSource> source;
  source->SetViaDiameter(-1.0);
  source->Update();
  EXPECT_GT(source->GetOutput()->GetNumberOfCells(), 0);
}
} // namespace
