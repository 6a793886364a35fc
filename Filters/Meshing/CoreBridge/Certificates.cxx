// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Certificates.h"

#include "CoreBridge/Outputs.h"
#include "CoreBridge/Texts.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace
{
/** Names of the counts, by cdm::MeshFault. */
constexpr const char* FaultNames[cdm::NumberOfMeshFaults] = { "InvertedTetrahedra",
  "FlatTetrahedra", "OverfullFacets", "NonDelaunayTetrahedra", "NonDelaunayFacets",
  "FacetSphereViolations", "EdgeSphereViolations", "OpenControlVolumes", "NegativeCouplings",
  "NegativeCotangentSums" };

std::vector<std::pair<const char*, vtkIdType>> GetCounts(const cdm::MeshCertificate& certificate)
{
  std::vector<std::pair<const char*, vtkIdType>> counts{ { "IsClean", certificate.IsClean() } };
  for (int fault = 0; fault < cdm::NumberOfMeshFaults; ++fault)
  {
    counts.emplace_back(FaultNames[fault], certificate.Faults[fault]);
  }
  counts.insert(counts.end(),
    { { "Facets", certificate.Facets }, { "BorderFacets", certificate.BorderFacets },
      { "StructuralEdges", certificate.StructuralEdges }, { "Edges", certificate.Edges },
      { "Couplings", certificate.Couplings }, { "CoincidentPoints", certificate.CoincidentPoints },
      { "TetrahedraUnder5Degrees", certificate.Under5Degrees.Count },
      { "TetrahedraUnder10Degrees", certificate.Under10Degrees.Count },
      { "TetrahedraUnder15Degrees", certificate.Under15Degrees.Count },
      { "FlatTetrahedraAtSharpAngles", certificate.Under15Degrees.AtSharpAngles },
      { "FlatTetrahedraAcrossLayers", certificate.Under15Degrees.AcrossLayers } });
  return counts;
}

template <typename Array, typename Function>
void AddArray(vtkFieldData* data, const char* name, std::size_t count, const Function& getValue)
{
  data->AddArray(vtkCoreBridge::MakeArray<Array>(name, count, getValue));
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
void AddCertificate(const cdm::MeshCertificate& certificate, vtkFieldData* data)
{
  std::vector<std::string> lines;
  std::istringstream text(certificate.GetText());
  for (std::string line; std::getline(text, line);)
  {
    lines.push_back(line);
  }
  SetTexts("Certificate", lines, data);
  for (const auto& count : GetCounts(certificate))
  {
    AddArray<vtkIdTypeArray>(data, count.first, 1, [&count](std::size_t) { return count.second; });
  }
  const auto addNumber = [data](const char* name, double number)
  { AddArray<vtkDoubleArray>(data, name, 1, [number](std::size_t) { return number; }); };
  addNumber("MeshSmallestDihedralAngle", certificate.SmallestDihedralAngle);
  addNumber("MeshLargestDihedralAngle", certificate.LargestDihedralAngle);
  addNumber("SmallestVolumeRatio", certificate.SmallestVolumeRatio);
  const auto& regions = certificate.Regions;
  AddArray<vtkIntArray>(
    data, "RegionIds", regions.size(), [&](std::size_t i) { return regions[i].Region; });
  AddArray<vtkDoubleArray>(
    data, "RegionVolumes", regions.size(), [&](std::size_t i) { return regions[i].Volume; });
  AddArray<vtkDoubleArray>(data, "RegionVolumeErrors", regions.size(),
    [&](std::size_t i) { return regions[i].GetRelativeError(); });
  AddArray<vtkDoubleArray>(data, "RegionUnsignedBoxRatios", regions.size(),
    [&](std::size_t i) { return regions[i].UnsignedBoxRatio; });
}

//--------------------------------------------------------------------------------------------------
void RemoveCertificate(vtkFieldData* data)
{
  vtkNew<vtkFieldData> names;
  AddCertificate({}, names);
  for (int i = 0; i < names->GetNumberOfArrays(); ++i)
  {
    data->RemoveArray(names->GetArrayName(i));
  }
}
} // namespace vtkCoreBridge
