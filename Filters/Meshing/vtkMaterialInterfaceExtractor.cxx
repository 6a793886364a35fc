// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMaterialInterfaceExtractor.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Outputs.h"
#include "CoreBridge/Reports.h"

#include "Core/Voxels/MaterialInterfaces.h"

#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkMaterialInterfaceExtractor);

namespace
{
/** Coordinates of the points along an axis; of a turned image those before it is turned. */
std::vector<double> GetPlaces(vtkDataSet* input, int axis)
{
  std::vector<double> places;
  if (auto image = vtkImageData::SafeDownCast(input))
  {
    const int* extent = image->GetExtent();
    const double origin =
      image->GetDirectionMatrix()->IsIdentity() ? image->GetOrigin()[axis] : 0.0;
    for (int i = extent[2 * axis]; i <= extent[2 * axis + 1]; ++i)
    {
      places.push_back(origin + image->GetSpacing()[axis] * i);
    }
    return places;
  }
  auto grid = vtkRectilinearGrid::SafeDownCast(input);
  vtkDataArray* coordinates = axis == 0 ? grid->GetXCoordinates()
    : axis == 1                         ? grid->GetYCoordinates()
                                        : grid->GetZCoordinates();
  for (vtkIdType i = 0; coordinates && i < coordinates->GetNumberOfTuples(); ++i)
  {
    places.push_back(coordinates->GetComponent(i, 0));
  }
  return places;
}

/** The ends of voxels around points; none for a single point, whose voxel has no size. */
std::vector<double> GetMiddles(const std::vector<double>& places)
{
  std::vector<double> middles;
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    const double half = 0.5 * (places[i] - places[i - 1]);
    if (i == 1)
    {
      middles.push_back(places[0] - half);
    }
    middles.push_back(places[i - 1] + half);
    if (i + 1 == places.size())
    {
      middles.push_back(places[i] + half);
    }
  }
  return middles;
}

cdm::Status ToLabelledGrid(
  vtkDataSet* input, vtkDataArray* labels, int association, int background, cdm::LabelledGrid& grid)
{
  const bool isOnPoints = association == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  const vtkIdType count = isOnPoints ? input->GetNumberOfPoints() : input->GetNumberOfCells();
  if (!labels || labels->GetNumberOfComponents() != 1 || labels->GetNumberOfTuples() != count)
  {
    return cdm::Status::InvalidInput(
      "The array to process has to be a point or cell array with one "
      "component, the labels: choose one (SetInputArrayToProcess).");
  }
  if (count > std::numeric_limits<cdm::Id>::max())
  {
    return cdm::Status::InvalidInput(
      "The input has more than 2^31 - 1 voxels: cut it into blocks.");
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<double> places = GetPlaces(input, axis);
    grid.Coordinates[axis] = isOnPoints ? GetMiddles(places) : places;
  }
  std::vector<cdm::Id> wrong;
  grid.Regions.resize(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double label = labels->GetComponent(i, 0);
    if (!(label >= cdm::OutsideRegion && label <= std::numeric_limits<cdm::Id>::max()) ||
      label != std::floor(label))
    {
      wrong.push_back(static_cast<cdm::Id>(i));
      continue;
    }
    const cdm::Id region = static_cast<cdm::Id>(label);
    grid.Regions[i] = region == background ? cdm::OutsideRegion : region;
  }
  if (wrong.empty())
  {
    return {};
  }
  const char* const message = "Labels have to be whole numbers from 0 on, or -1 for outside.";
  return isOnPoints ? cdm::Status::InvalidInput(message, {}, std::move(wrong))
                    : cdm::Status::InvalidInput(message, std::move(wrong));
}

/** Turns what was made along the axes of an image. */
void Turn(vtkImageData* image, cdm::TriangleMesh& surface)
{
  vtkMatrix3x3* direction = image->GetDirectionMatrix();
  const double* origin = image->GetOrigin();
  for (cdm::Vec3& p : surface.Points)
  {
    const double before[3] = { p.X, p.Y, p.Z };
    double after[3];
    direction->MultiplyPoint(before, after);
    p = { origin[0] + after[0], origin[1] + after[1], origin[2] + after[2] };
  }
  if (direction->Determinant() < 0.0)
  {
    for (cdm::TriangleIds& ids : surface.Triangles)
    {
      std::swap(ids[1], ids[2]);
    }
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkMaterialInterfaceExtractor::vtkMaterialInterfaceExtractor()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
}

//--------------------------------------------------------------------------------------------------
int vtkMaterialInterfaceExtractor::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkRectilinearGrid");
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkMaterialInterfaceExtractor::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // A part of the voxels would get a border of its own: each process asks for all of them.
  vtkInformation* info = inputVector[0]->GetInformationObject(0);
  info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(), 0);
  info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  if (info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
      info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
int vtkMaterialInterfaceExtractor::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataSet* input = vtkDataSet::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector) ||
    outputVector->GetInformationObject(0)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) > 0)
  {
    // The first process makes all interfaces.
    return 1;
  }

  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* labels = this->GetInputArrayToProcess(0, inputVector, association);
  cdm::TriangleMesh surface;
  cdm::MaterialInterfacesReport report;
  const cdm::Status status = cdm::RunGuarded(
    [&]
    {
      cdm::LabelledGrid grid;
      cdm::Status step = ToLabelledGrid(input, labels, association, this->BackgroundLabel, grid);
      if (step.IsOk())
      {
        cdm::MaterialInterfacesOptions options;
        options.SmoothingLength = this->SmoothingLength;
        options.Reduce = this->ReduceSurface;
        options.MaximumDeviation = this->MaximumDeviation;
        options.FeatureAngle = this->FeatureAngle;
        step = cdm::ExtractMaterialInterfaces(
          grid, options, vtkCoreBridge::MakeContext(this), surface, report);
      }
      return step;
    });
  this->NumberOfFaces = report.Faces;
  this->NumberOfHeldPoints = report.HeldPoints;
  this->NumberOfRemovedPoints = report.RemovedPoints;
  this->LargestDeviation = report.LargestDeviation;
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }

  auto image = vtkImageData::SafeDownCast(input);
  if (image && !image->GetDirectionMatrix()->IsIdentity())
  {
    Turn(image, surface);
  }
  vtkCoreBridge::FromTriangleMesh(surface, vtkPolyData::GetData(outputVector));
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkMaterialInterfaceExtractor::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "BackgroundLabel: " << this->BackgroundLabel << "\n";
  os << indent << "SmoothingLength: " << this->SmoothingLength << "\n";
  os << indent << "ReduceSurface: " << this->ReduceSurface << "\n";
  os << indent << "MaximumDeviation: " << this->MaximumDeviation << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "NumberOfFaces: " << this->NumberOfFaces << "\n";
  os << indent << "NumberOfHeldPoints: " << this->NumberOfHeldPoints << "\n";
  os << indent << "NumberOfRemovedPoints: " << this->NumberOfRemovedPoints << "\n";
  os << indent << "LargestDeviation: " << this->LargestDeviation << "\n";
}
