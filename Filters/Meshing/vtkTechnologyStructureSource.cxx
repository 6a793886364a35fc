// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTechnologyStructureSource.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Texts.h"
#include "Devices/Device.h"
#include "Devices/vtkStructureOutput.h"

#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

#include <cmath>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkTechnologyStructureSource);

namespace
{
/** Rodrigues' formula; coordinates along an axis of the frame stay exact. */
std::string Rotate(double angle, const double axis[3], std::vector<cdm::Vec3>& points)
{
  const cdm::Vec3 direction{ axis[0], axis[1], axis[2] };
  if (!std::isfinite(angle))
  {
    return "RotationAngle has to be finite.";
  }
  if (!cdm::IsFinite(direction) || direction == cdm::Vec3{})
  {
    return "RotationAxis has to be finite and not zero.";
  }
  // Scaled by hypot, which neither overflows nor underflows.
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  const cdm::Vec3 unit{ axis[0] / length, axis[1] / length, axis[2] / length };
  const cdm::CosineSine turn = cdm::GetCosineSine(angle);
  for (cdm::Vec3& point : points)
  {
    const cdm::Vec3 parallel = cdm::Dot(unit, point) * unit;
    point = parallel + turn.Cosine * (point - parallel) + turn.Sine * cdm::Cross(unit, point);
  }
  return {};
}
} // namespace

vtkTechnologyStructureSource::vtkTechnologyStructureSource()
{
  this->SetNumberOfInputPorts(0);
}

int vtkTechnologyStructureSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  output->Initialize();
  cdm::Device device;
  std::string problem = this->MakeDevice(device);
  // Their places are those of the device as it is made.
  const std::vector<cdm::Id> contactIds = device.FindContactIds();
  if (problem.empty() && this->RotationAngle != 0.0)
  {
    problem = Rotate(this->RotationAngle, this->RotationAxis, device.Boundary.Points);
  }
  if (!problem.empty())
  {
    vtkErrorMacro("" << this->GetStructureAsString() << ": " << problem);
    return 0;
  }
  vtkStructureOutput::SetPolygons(device.Boundary, device.FacetIds, output);
  vtkStructureOutput::AddIds("ContactId", contactIds, output);
  using vtkCoreBridge::SetTexts;
  SetTexts(vtkCoreBridge::RegionNamesName, device.RegionNames, output->GetFieldData());
  std::vector<std::string> contactNames;
  for (const cdm::Contact& contact : device.Contacts)
  {
    contactNames.push_back(contact.Name);
  }
  SetTexts(vtkCoreBridge::ContactNamesName, contactNames, output->GetFieldData());
  return 1;
}

std::string vtkTechnologyStructureSource::MakeDevice(cdm::Device& device)
{
  switch (this->Structure)
  {
    case MOS_TRANSISTOR:
      return cdm::MakeMosTransistor(
        { this->GateLength, this->GateHeight, this->GateOxideThickness, this->SpacerWidth,
          this->BulkLength, this->BulkDepth, this->DeviceWidth, this->SpacerSegments },
        device);
    case VIA_PLUG:
      return cdm::MakeViaPlug(
        { this->ViaDiameter, this->ViaHeight, this->BottomLineWidth, this->BottomLineThickness,
          this->TopLineWidth, this->TopLineThickness, this->BoxSize, this->NumberOfSegments },
        device);
    case NMOS_WITH_FIELD_OXIDE:
      return cdm::MakeNmosTransistor(
        { this->GateLength, this->GateHeight, this->GateOxideThickness, this->BulkLength,
          this->BulkDepth, this->DeviceWidth, this->ChannelWidth, this->FieldOxideThickness,
          this->CoverOxideThickness },
        device);
    case LOCOS:
      return cdm::MakeLocos({ this->BulkLength, this->BulkDepth, this->DeviceWidth,
                              this->FieldOxideThickness, this->PadOxideThickness,
                              this->NitrideThickness, this->StepLength, this->ProfileSegments },
        device);
    case DRAM_INTERCONNECT:
      return cdm::MakeDramInterconnect(
        { this->LinePitch, this->LineWidth, this->LineThickness, this->InsulatorThickness,
          this->SidewallAngle, this->NumberOfWordLines, this->NumberOfBitLines },
        device);
    case TWO_LAYER_INTERCONNECT:
      return cdm::MakeTwoLayerInterconnect(
        { this->LinePitch, this->LineWidth, this->LineThickness, this->InsulatorThickness,
          this->BulkDepth, this->StepLength, this->ProfileSegments },
        device);
    case VIA_WITH_BARRIER:
    case DAMASCENE:
      return cdm::MakeLinedVia(
        { this->ViaDiameter, this->ViaHeight, this->BottomLineThickness, this->BarrierThickness,
          this->BarrierAsymmetry, this->GasHeight, this->BoxSize, this->TrenchWidth,
          this->TrenchDepth, this->NumberOfSegments, this->Structure == DAMASCENE },
        device);
    default:
      return cdm::MakeCmosInverter(
        { this->GateLength, this->GateHeight, this->GateOxideThickness, this->SpacerWidth,
          this->BulkDepth, this->ChannelWidth, this->DiffusionLength, this->ContactWidth,
          this->TrenchWidth, this->TrenchDepth, this->InsulatorThickness, this->LineThickness,
          this->PassivationThickness, this->SpacerSegments },
        device);
  }
}

const char* vtkTechnologyStructureSource::GetStructureAsString()
{
  static const char* const names[] = { "MosTransistor", "ViaPlug", "NmosWithFieldOxide", "Locos",
    "DramInterconnect", "TwoLayerInterconnect", "ViaWithBarrier", "Damascene", "CmosInverter" };
  return names[this->Structure];
}

void vtkTechnologyStructureSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Structure: " << this->GetStructureAsString() << endl;
  os << indent << "GateLength: " << this->GateLength << endl;
  os << indent << "GateHeight: " << this->GateHeight << endl;
  os << indent << "GateOxideThickness: " << this->GateOxideThickness << endl;
  os << indent << "SpacerWidth: " << this->SpacerWidth << endl;
  os << indent << "SpacerSegments: " << this->SpacerSegments << endl;
  os << indent << "BulkLength: " << this->BulkLength << endl;
  os << indent << "BulkDepth: " << this->BulkDepth << endl;
  os << indent << "DeviceWidth: " << this->DeviceWidth << endl;
  os << indent << "ChannelWidth: " << this->ChannelWidth << endl;
  os << indent << "FieldOxideThickness: " << this->FieldOxideThickness << endl;
  os << indent << "CoverOxideThickness: " << this->CoverOxideThickness << endl;
  os << indent << "ViaDiameter: " << this->ViaDiameter << endl;
  os << indent << "ViaHeight: " << this->ViaHeight << endl;
  os << indent << "NumberOfSegments: " << this->NumberOfSegments << endl;
  os << indent << "BottomLineWidth: " << this->BottomLineWidth << endl;
  os << indent << "BottomLineThickness: " << this->BottomLineThickness << endl;
  os << indent << "TopLineWidth: " << this->TopLineWidth << endl;
  os << indent << "TopLineThickness: " << this->TopLineThickness << endl;
  os << indent << "BoxSize: " << this->BoxSize << endl;
  os << indent << "PadOxideThickness: " << this->PadOxideThickness << endl;
  os << indent << "NitrideThickness: " << this->NitrideThickness << endl;
  os << indent << "StepLength: " << this->StepLength << endl;
  os << indent << "ProfileSegments: " << this->ProfileSegments << endl;
  os << indent << "LinePitch: " << this->LinePitch << endl;
  os << indent << "LineWidth: " << this->LineWidth << endl;
  os << indent << "LineThickness: " << this->LineThickness << endl;
  os << indent << "InsulatorThickness: " << this->InsulatorThickness << endl;
  os << indent << "SidewallAngle: " << this->SidewallAngle << endl;
  os << indent << "NumberOfWordLines: " << this->NumberOfWordLines << endl;
  os << indent << "NumberOfBitLines: " << this->NumberOfBitLines << endl;
  os << indent << "BarrierThickness: " << this->BarrierThickness << endl;
  os << indent << "BarrierAsymmetry: " << this->BarrierAsymmetry << endl;
  os << indent << "GasHeight: " << this->GasHeight << endl;
  os << indent << "TrenchWidth: " << this->TrenchWidth << endl;
  os << indent << "TrenchDepth: " << this->TrenchDepth << endl;
  os << indent << "DiffusionLength: " << this->DiffusionLength << endl;
  os << indent << "ContactWidth: " << this->ContactWidth << endl;
  os << indent << "PassivationThickness: " << this->PassivationThickness << endl;
  os << indent << "RotationAngle: " << this->RotationAngle << endl;
  os << indent << "RotationAxis: " << this->RotationAxis[0] << ' ' << this->RotationAxis[1] << ' '
     << this->RotationAxis[2] << endl;
}
