// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTechnologyStructureSource.h"

#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace
{
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

TEST(TechnologyStructureErrors, NameTheParameters)
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

TEST(TechnologyStructureErrors, OfInterconnectsAndInverter)
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
} // namespace
