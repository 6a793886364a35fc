// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/SizingInputs.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"

#include "Core/Basics/IdLimits.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkStaticPointLocator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace
{
constexpr int MaximumSizingComponents = 9;

std::string ListValues(const double* values, int count)
{
  std::ostringstream text;
  for (int i = 0; i < count; ++i)
  {
    text << (i ? ", " : "") << values[i];
  }
  return text.str();
}

/** Principal values and directions (rows) of a symmetric tensor in VTK's 6 or 9 components. */
void FindPrincipalAxes(
  const double* tensor, int components, double (&lengths)[3], double (&directions)[3][3])
{
  static const int places6[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } };
  double matrix[3][3];
  double columns[3][3];
  double* matrixRows[3] = { matrix[0], matrix[1], matrix[2] };
  double* columnRows[3] = { columns[0], columns[1], columns[2] };
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      matrix[i][j] =
        components == 6 ? tensor[places6[i][j]] : 0.5 * (tensor[3 * i + j] + tensor[3 * j + i]);
    }
  }
  vtkMath::Jacobi(matrixRows, lengths, columnRows);
  vtkMath::Transpose3x3(columns, directions);
}

/** Interpolates the array Sizing of a data set, for several threads at once; see ToSizing(). */
class SizingInterpolator
{
public:
  SizingInterpolator(vtkDataSet* data, vtkDataArray* values)
    : Values(values), Components(values->GetNumberOfComponents())
  {
    // A copy of its own: locators build caches in the data set that they search.
    this->Data = vtkCoreBridge::CopyWithoutBlanking(data);
    // Grids along the axes find cells by themselves.
    this->IsGrid = (data->IsA("vtkImageData") || data->IsA("vtkRectilinearGrid")) &&
      data->GetNumberOfCells() > 0;
    if (data->GetNumberOfCells() > 0 && !this->IsGrid)
    {
      this->Cells->SetDataSet(this->Data);
      this->Cells->BuildLocator();
    }
    this->Points->SetDataSet(this->Data);
    this->Points->BuildLocator();
    // What data sets make at the first query of its kind must be there before several threads ask.
    this->Data->GetBounds(this->Bounds);
    if (data->GetNumberOfCells() > 0)
    {
      vtkNew<vtkGenericCell> cell;
      this->Data->GetCell(0, cell);
    }
    this->NumberOfWeights = std::max(8, this->Data->GetMaxCellSize());
  }

  cdm::LocalSpacing operator()(const cdm::Vec3& position) const
  {
    // One for each thread, without a lock: threads that ask for one all the time wait for each
    // other.
    thread_local Place place;
    place.Weights.resize(this->NumberOfWeights);
    return this->Find(position, place);
  }

private:
  /** A cell and the weights of its points at a position. */
  struct Place
  {
    vtkNew<vtkGenericCell> Cell;
    std::vector<double> Weights;
  };

  struct Sum
  {
    double Value[MaximumSizingComponents];
    /** Bounds of the values. */
    double Low[MaximumSizingComponents];
    double High[MaximumSizingComponents];
    /** Work space for one of the values. */
    double Tuple[MaximumSizingComponents];
  };

  cdm::LocalSpacing Find(const cdm::Vec3& position, Place& place) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double x[3] = { position.X, position.Y, position.Z };
    Sum sum;
    if (this->FindCell(x, place) < 0)
    {
      this->Values->GetTuple(this->Points->FindClosestPoint(x), sum.Tuple);
      std::copy_n(sum.Tuple, this->Components, sum.Value);
      std::fill_n(sum.Low, this->Components, 0.0);
      std::fill_n(sum.High, this->Components, infinity);
      return this->MakeSpacing(sum);
    }
    std::fill_n(sum.Value, this->Components, 0.0);
    std::fill_n(sum.Low, this->Components, infinity);
    std::fill_n(sum.High, this->Components, 0.0);
    for (vtkIdType i = 0; i < place.Cell->GetNumberOfPoints(); ++i)
    {
      this->Values->GetTuple(place.Cell->GetPointId(i), sum.Tuple);
      for (int j = 0; j < this->Components; ++j)
      {
        sum.Value[j] += place.Weights[i] * sum.Tuple[j];
        sum.Low[j] = std::min(sum.Low[j], sum.Tuple[j]);
        sum.High[j] = std::max(sum.High[j], sum.Tuple[j]);
      }
    }
    return this->MakeSpacing(sum);
  }

  /** The cell that holds a position, or is nearest to it, with its weights there; or -1. */
  vtkIdType FindCell(double x[3], Place& place) const
  {
    if (this->Data->GetNumberOfCells() == 0)
    {
      return -1;
    }
    int subId = 0;
    double parametric[3];
    double distance2 = 0.0;
    if (this->IsGrid)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        x[axis] = std::min(std::max(x[axis], this->Bounds[2 * axis]), this->Bounds[2 * axis + 1]);
      }
      const vtkIdType cell = this->Data->FindCell(
        x, nullptr, place.Cell, -1, 0.0, subId, parametric, place.Weights.data());
      if (cell >= 0)
      {
        this->Data->GetCell(cell, place.Cell);
      }
      return cell;
    }
    vtkIdType cell = this->Cells->FindCell(x, 0.0, place.Cell, parametric, place.Weights.data());
    if (cell < 0)
    {
      double closest[3];
      this->Cells->FindClosestPoint(x, closest, place.Cell, cell, subId, distance2);
      if (cell >= 0)
      {
        place.Cell->EvaluatePosition(
          closest, nullptr, subId, parametric, distance2, place.Weights.data());
      }
    }
    return cell;
  }

  /**
   * Makes a spacing of a weighted sum, within the bounds of the values: a degenerate cell gives
   * weights of any kind.
   */
  cdm::LocalSpacing MakeSpacing(Sum& sum) const
  {
    if (this->Components <= 3)
    {
      for (int j = 0; j < this->Components; ++j)
      {
        sum.Value[j] = std::isfinite(sum.Value[j])
          ? std::min(std::max(sum.Value[j], sum.Low[j]), sum.High[j])
          : sum.Low[j];
      }
      return this->Components == 1
        ? cdm::LocalSpacing(sum.Value[0])
        : cdm::LocalSpacing(cdm::Vec3{ sum.Value[0], sum.Value[1], sum.Value[2] });
    }
    double lengths[3];
    double directions[3][3];
    if (!std::all_of(sum.Value, sum.Value + this->Components,
          [](double value) { return std::isfinite(value); }))
    {
      std::copy_n(sum.Tuple, this->Components, sum.Value);
    }
    FindPrincipalAxes(sum.Value, this->Components, lengths, directions);
    if (!(std::min({ lengths[0], lengths[1], lengths[2] }) > 0.0))
    {
      FindPrincipalAxes(sum.Tuple, this->Components, lengths, directions);
    }
    cdm::Vec3 axes[3];
    for (int i = 0; i < 3; ++i)
    {
      axes[i] = { directions[i][0], directions[i][1], directions[i][2] };
    }
    return { cdm::Vec3{ lengths[0], lengths[1], lengths[2] }, axes };
  }

  vtkSmartPointer<vtkDataSet> Data;
  vtkSmartPointer<vtkDataArray> Values;
  int Components;
  bool IsGrid = false;
  double Bounds[6];
  std::size_t NumberOfWeights;
  vtkNew<vtkStaticCellLocator> Cells;
  vtkNew<vtkStaticPointLocator> Points;
};

/** The smallest principal value of the array Sizing at each point, or an error. */
cdm::Status FindSmallestLengths(vtkDataArray* values, std::vector<double>& smallest)
{
  const int components = values->GetNumberOfComponents();
  smallest.resize(values->GetNumberOfTuples());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    double tuple[MaximumSizingComponents];
    values->GetTuple(i, tuple);
    bool isGood =
      std::all_of(tuple, tuple + components, [](double value) { return std::isfinite(value); });
    double lengths[3] = { tuple[0], tuple[components > 1 ? 1 : 0], tuple[components > 1 ? 2 : 0] };
    if (isGood && components > 3)
    {
      double directions[3][3];
      FindPrincipalAxes(tuple, components, lengths, directions);
    }
    const double largest = std::max({ lengths[0], lengths[1], lengths[2] });
    for (int j = 0; j < 3 && components == 9; ++j)
    {
      isGood = isGood &&
        std::abs(tuple[3 * j + (j + 1) % 3] - tuple[3 * ((j + 1) % 3) + j]) <= 1e-6 * largest;
    }
    smallest[i] = std::min({ lengths[0], lengths[1], lengths[2] });
    if (!isGood || !(smallest[i] > 0.0))
    {
      return cdm::Status::InvalidInput(std::string("The point array Sizing must be positive and "
                                                   "finite, and a tensor symmetric") +
        "; its value at point " + std::to_string(i) + " of the sizing input is " +
        ListValues(tuple, components) + ".");
    }
  }
  return {};
}

/** Copies all points, with several threads. */
std::vector<cdm::Vec3> CopyPoints(vtkDataSet* input)
{
  std::vector<cdm::Vec3> points(input->GetNumberOfPoints());
  vtkCoreBridge::ForEach(points.size(),
    [&](std::size_t i)
    {
      double x[3];
      input->GetPoint(static_cast<vtkIdType>(i), x);
      points[i] = { x[0], x[1], x[2] };
    });
  return points;
}

/** Appends the corners of a cell: as it is, or in simplices; its points if these cannot be had. */
void AppendCell(vtkGenericCell* cell, vtkIdList* ids, vtkPoints* points, cdm::SizingCells& cells)
{
  const auto append = [&](vtkIdList* corners, const std::vector<vtkIdType>& order)
  {
    for (const vtkIdType i : order)
    {
      cells.Connectivity.push_back(static_cast<cdm::Id>(corners->GetId(i)));
    }
    cells.Offsets.push_back(static_cast<cdm::Id>(cells.Connectivity.size()));
  };
  switch (cell->GetCellType())
  {
    case VTK_EMPTY_CELL:
      return;
    case VTK_TETRA:
      return append(cell->GetPointIds(), { 0, 1, 2, 3 });
    case VTK_HEXAHEDRON:
      return append(cell->GetPointIds(), { 0, 1, 2, 3, 4, 5, 6, 7 });
    case VTK_VOXEL:
      return append(cell->GetPointIds(), { 0, 1, 3, 2, 4, 5, 7, 6 });
    default:
      break;
  }
  vtkIdType size = cell->GetCellDimension() + 1;
  if (!cell->Triangulate(0, ids, points) || ids->GetNumberOfIds() % size != 0)
  {
    ids->DeepCopy(cell->GetPointIds());
    size = 1;
  }
  for (vtkIdType i = 0; i + size <= ids->GetNumberOfIds(); i += size)
  {
    std::vector<vtkIdType> order(size);
    std::iota(order.begin(), order.end(), i);
    append(ids, order);
  }
}

/**
 * Finds minima of a sizing in the cells of a data set, or at its points if it has no cells.
 * lengths: the smallest length at each point.
 */
cdm::Status FindMinima(
  vtkDataSet* input, std::vector<double> lengths, std::shared_ptr<const cdm::SizingMinima>& minima)
{
  cdm::Status status = cdm::CheckIdRange(input->GetNumberOfPoints(), "points");
  if (!status.IsOk())
  {
    return status;
  }
  cdm::SizingCells cells;
  cells.Points = CopyPoints(input);
  vtkNew<vtkGenericCell> cell;
  vtkNew<vtkIdList> ids;
  vtkNew<vtkPoints> points;
  for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
  {
    input->GetCell(i, cell);
    AppendCell(cell, ids, points, cells);
    status = cdm::CheckIdRange(cells.Connectivity.size(), "corners of cells");
    if (!status.IsOk())
    {
      return status;
    }
  }
  minima = std::make_shared<const cdm::SizingMinima>(std::move(cells), std::move(lengths));
  return {};
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
cdm::Status ToSizing(vtkDataSet* input, cdm::SizingField& sizing)
{
  vtkDataArray* values = input->GetPointData()->GetArray(SizingName);
  const int components = values ? values->GetNumberOfComponents() : 0;
  if (!values || values->GetNumberOfTuples() == 0 ||
    (components != 1 && components != 3 && components != 6 && components != 9))
  {
    return cdm::Status::InvalidInput(
      "The sizing input needs a point array Sizing, the target edge length in model units: one "
      "component, 3 (for each axis), or 6 or 9 (a symmetric tensor).");
  }
  std::vector<double> lengths;
  std::shared_ptr<const cdm::SizingMinima> minima;
  const cdm::Status status = CheckArrays(input)
                               .Then([&] { return FindSmallestLengths(values, lengths); })
                               .Then([&] { return FindMinima(input, std::move(lengths), minima); });
  if (!status.IsOk())
  {
    return status;
  }
  const auto interpolator = std::make_shared<const SizingInterpolator>(input, values);
  sizing = cdm::SizingField(
    [interpolator](const cdm::Vec3& position) { return (*interpolator)(position); }, minima);
  return {};
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkDataSet> CopyWithoutBlanking(vtkDataSet* input)
{
  auto copy = vtk::TakeSmartPointer(input->NewInstance());
  copy->ShallowCopy(input);
  copy->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  copy->GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  return copy;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToSizingCells(vtkDataSet* input, cdm::SizingCells& cells)
{
  const vtkIdType count = input->GetNumberOfPoints();
  for (const cdm::Status& status : { CheckArrays(input), cdm::CheckIdRange(count, "points"),
         cdm::CheckIdRange(input->GetNumberOfCells(), "cells") })
  {
    if (!status.IsOk())
    {
      return status;
    }
  }
  cells.Points = CopyPoints(input);
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    input->GetCellPoints(cell, ids);
    const vtkIdType size = ids->GetNumberOfIds();
    const cdm::Status status =
      cdm::CheckIdRange(cells.Connectivity.size() + size, "corners of cells");
    if (!status.IsOk())
    {
      return status;
    }
    if (UsesMissingPoints(size, ids->GetPointer(0), count))
    {
      return MissingPoints({ static_cast<cdm::Id>(cell) });
    }
    for (vtkIdType i = 0; i < size; ++i)
    {
      cells.Connectivity.push_back(static_cast<cdm::Id>(ids->GetId(i)));
    }
    cells.Offsets.push_back(static_cast<cdm::Id>(cells.Connectivity.size()));
  }
  return {};
}
} // namespace vtkCoreBridge
