// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCoreBridge.h"

#include "vtkConformingDelaunayCompatibility.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Certificate/MeshChecks.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkStaticCellLocator.h>
#include <vtkStaticPointLocator.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

namespace
{
constexpr std::size_t NamedIds = 10;

/** A whole number from -1 on that fits into an id; otherwise false. */
bool ToRegion(double value, cdm::Id& region)
{
  if (!(value >= cdm::OutsideRegion && value <= static_cast<double>(cdm::LargestId)) ||
    value != std::floor(value))
  {
    return false;
  }
  region = static_cast<cdm::Id>(value);
  return true;
}

cdm::Status ToVectors(vtkPoints* input, std::vector<cdm::Vec3>& points)
{
  const vtkIdType count = input ? input->GetNumberOfPoints() : 0;
  const cdm::Status status = cdm::CheckIdRange(count, "points");
  if (!status.IsOk())
  {
    return status;
  }
  points.resize(count);
  vtkCoreBridge::ForEach(points.size(),
    [&](std::size_t i)
    {
      double x[3];
      input->GetPoint(static_cast<vtkIdType>(i), x);
      points[i] = { x[0], x[1], x[2] };
    });
  return status;
}

/** Labels of the given cells; empty without the array. */
cdm::Status ToLabels(
  vtkPolyData* input, const std::vector<vtkIdType>& cells, std::vector<cdm::RegionPair>& labels)
{
  vtkAbstractArray* any = input->GetCellData()->GetAbstractArray(vtkCoreBridge::BoundaryLabelsName);
  labels.clear();
  if (!any)
  {
    return {};
  }
  auto array = vtkDataArray::SafeDownCast(any);
  if (!array || array->GetNumberOfComponents() != 2 ||
    array->GetNumberOfTuples() != input->GetNumberOfCells())
  {
    return cdm::Status::InvalidInput(
      "The cell array BoundaryLabels must hold two integers for each cell: the region ids on its "
      "front and on its back side, -1 for outside. Correct, rename or remove it.");
  }
  labels.resize(cells.size());
  std::vector<cdm::Id> wrong;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    if (!ToRegion(array->GetComponent(cells[i], 0), labels[i].Front) ||
      !ToRegion(array->GetComponent(cells[i], 1), labels[i].Back))
    {
      wrong.push_back(static_cast<cdm::Id>(cells[i]));
    }
  }
  if (!wrong.empty())
  {
    wrong.erase(std::unique(wrong.begin(), wrong.end()), wrong.end());
    return cdm::Status::InvalidInput(
      "The cell array BoundaryLabels holds values that are no region ids: they are whole numbers "
      "from 0 on, or -1 for outside.",
      std::move(wrong));
  }
  return {};
}

cdm::Status NotTetrahedra(std::vector<cdm::Id> cells)
{
  return cdm::Status::InvalidInput(
    "The input has cells that are not linear tetrahedra (VTK_TETRA). Remove or split them.",
    std::move(cells));
}

int GetCellDimension(int type)
{
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  // Of a type that this VTK does not know nothing can be told.
  return cell ? cell->GetCellDimension() : 3;
}

/** Arrays that are shorter than the data set would be read behind their end. */
cdm::Status CheckArrays(vtkDataSet* input)
{
  if (input->CheckAttributes())
  {
    return cdm::Status::InvalidInput(
      "An array of the input has fewer tuples than the input has points or cells.");
  }
  return {};
}

/** What both conversions of a surface check before they look at a cell. */
cdm::Status CheckSurface(vtkPolyData* input)
{
  for (const cdm::Status& status : { cdm::CheckIdRange(input->GetNumberOfCells(), "cells"),
         cdm::CheckNumberOfTriangles(input->GetNumberOfPolys() + input->GetNumberOfStrips()) })
  {
    if (!status.IsOk())
    {
      return status;
    }
  }
  if (input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    return cdm::Status::InvalidInput(
      "The input is empty: it has no polygons. A closed polygonal surface is needed.");
  }
  return CheckArrays(input);
}

cdm::Status MissingPoints(std::vector<cdm::Id> cells)
{
  return cdm::Status::InvalidInput(
    "Cells of the input use points that do not exist.", std::move(cells));
}

bool UsesMissingPoints(vtkIdType size, const vtkIdType* ids, vtkIdType numberOfPoints)
{
  return std::any_of(ids, ids + size, [=](vtkIdType id) { return id < 0 || id >= numberOfPoints; });
}

/** Triangles that a stage made by itself have no cell to name. */
void DropNoId(std::vector<cdm::Id>& ids)
{
  ids.erase(std::remove(ids.begin(), ids.end(), cdm::NoId), ids.end());
}

void AddPolygon(cdm::PolygonSoup& soup, vtkIdType size, const vtkIdType* ids)
{
  for (vtkIdType i = 0; i < size; ++i)
  {
    soup.Connectivity.push_back(static_cast<cdm::Id>(ids[i]));
  }
  soup.Offsets.push_back(static_cast<cdm::Id>(soup.Connectivity.size()));
}

/** Numbers the points that are used in the order of their first use. */
class PointSelection
{
public:
  explicit PointSelection(std::size_t numberOfPoints) : NewIds(numberOfPoints, -1) {}
  vtkIdType Add(cdm::Id point)
  {
    if (this->NewIds[point] < 0)
    {
      this->NewIds[point] = static_cast<vtkIdType>(this->Sources.size());
      this->Sources.push_back(point);
    }
    return this->NewIds[point];
  }
  const std::vector<vtkIdType>& GetSources() const { return this->Sources; }

private:
  std::vector<vtkIdType> NewIds;
  std::vector<vtkIdType> Sources;
};

std::string ListIds(const char* what, const std::vector<vtkIdType>& ids,
  const std::function<void(std::ostream&, vtkIdType)>& describe)
{
  if (ids.empty())
  {
    return {};
  }
  std::ostringstream text;
  text.precision(17);
  text << ' ' << what << ": ";
  for (std::size_t i = 0; i < std::min(ids.size(), NamedIds); ++i)
  {
    text << (i ? ", " : "") << ids[i];
    describe(text, ids[i]);
  }
  text << (ids.size() > NamedIds ? ", ..." : "") << " (" << ids.size() << " in all).";
  return text.str();
}

std::string Describe(const cdm::Status& status, vtkDataSet* input)
{
  std::vector<vtkIdType> cells(status.Cells.begin(), status.Cells.end());
  vtkDataArray* names =
    input ? input->GetCellData()->GetArray(vtkCoreBridge::InputCellName) : nullptr;
  if (names)
  {
    for (vtkIdType& cell : cells)
    {
      cell = static_cast<vtkIdType>(names->GetComponent(cell, 0));
    }
  }
  const std::vector<vtkIdType> points(status.Points.begin(), status.Points.end());
  auto writePosition = [input](std::ostream& text, vtkIdType point)
  {
    if (input && point < input->GetNumberOfPoints())
    {
      double x[3];
      input->GetPoint(point, x);
      text << " (" << x[0] << ", " << x[1] << ", " << x[2] << ')';
    }
  };
  const bool isBug = status.Code == cdm::StatusCode::InternalError;
  return (isBug ? "Internal error, please report it: " : "") + status.Message +
    vtkCoreBridge::ListCells(std::move(cells)) + ListIds("Points", points, writePosition);
}

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
    this->Data.TakeReference(data->NewInstance());
    this->Data->ShallowCopy(data);
    // Grids along the axes find cells by themselves.
    this->IsGrid = (data->IsA("vtkImageData") || data->IsA("vtkRectilinearGrid")) &&
      data->GetNumberOfCells() > 0 && !data->HasAnyBlankCells();
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
    // One for each thread, without a lock: threads that ask for one all the time wait for each other.
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
    /** What the values lie between. */
    double Low[MaximumSizingComponents];
    double High[MaximumSizingComponents];
    /** One of the values. */
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

  /** Of the sum, within the bounds: a degenerate cell gives weights of any kind. */
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
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
cdm::ExecutionContext MakeContext(vtkAlgorithm* filter)
{
  // Stages may call in inner loops; observers (a GUI redraws) hear of steps that can be seen, and
  // now and then of none: they may want to abort.
  using Clock = std::chrono::steady_clock;
  constexpr double smallestStep = 0.005;
  static constexpr std::chrono::milliseconds longestSilence(200);
  double last = -1.0;
  std::string lastActivity;
  Clock::time_point lastTime;
  auto progress = [filter, last, lastActivity, lastTime](
                    double fraction, const char* activity) mutable
  {
    const Clock::time_point now = Clock::now();
    if (std::abs(fraction - last) >= smallestStep || lastActivity != activity ||
      now - lastTime >= longestSilence)
    {
      last = fraction;
      lastActivity = activity;
      lastTime = now;
      filter->SetProgressText(activity);
      filter->UpdateProgress(fraction);
    }
  };
  return { progress,
    [filter]() { return vtkConformingDelaunayCompatibility::CheckAbort(filter); } };
}

//--------------------------------------------------------------------------------------------------
cdm::Status Guard(const std::function<cdm::Status()>& function)
{
  try
  {
    return function();
  }
  catch (const std::bad_alloc&)
  {
    return cdm::Status::InvalidInput("There is not enough memory for this input.");
  }
  catch (const std::length_error&)
  {
    return cdm::Status::InvalidInput("There is not enough memory for this input.");
  }
}

//--------------------------------------------------------------------------------------------------
int GetNumberOfThreads()
{
  return vtkSMPTools::GetEstimatedNumberOfThreads();
}

//--------------------------------------------------------------------------------------------------
int ReportFailure(
  vtkAlgorithm* filter, vtkInformationVector* outputs, const cdm::Status& status, vtkDataSet* input)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
  if (status.IsAborted())
  {
    return 1;
  }
  ReportError(filter, status, input);
  return 0;
}

//--------------------------------------------------------------------------------------------------
void ReportError(vtkAlgorithm* filter, const cdm::Status& status, vtkDataSet* input)
{
  const std::string text = Describe(status, input);
  vtkErrorWithObjectMacro(filter, << text);
}

//--------------------------------------------------------------------------------------------------
std::string ListCells(std::vector<vtkIdType> cells)
{
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return ListIds("Cells", cells, [](std::ostream&, vtkIdType) {});
}

//--------------------------------------------------------------------------------------------------
bool IsIdleProcess(vtkDataSet* input, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const auto pieces = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
  return info->Has(pieces) && info->Get(pieces) > 1 && input->GetNumberOfCells() == 0;
}

//--------------------------------------------------------------------------------------------------
void OffsetCells(cdm::Status& status, vtkIdType offset)
{
  DropNoId(status.Cells);
  for (cdm::Id& cell : status.Cells)
  {
    cell = static_cast<cdm::Id>(cell + offset);
  }
}

//--------------------------------------------------------------------------------------------------
void MapCells(cdm::Status& status, const std::vector<vtkIdType>& cells)
{
  DropNoId(status.Cells);
  for (cdm::Id& cell : status.Cells)
  {
    cell = static_cast<cdm::Id>(cells[cell]);
  }
  // The triangles of one strip are one cell.
  status.Cells.erase(std::unique(status.Cells.begin(), status.Cells.end()), status.Cells.end());
}

//--------------------------------------------------------------------------------------------------
vtkIdType GetFirstPolygon(vtkPolyData* surface)
{
  return surface->GetNumberOfVerts() + surface->GetNumberOfLines();
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToPolygonSoup(vtkPolyData* input, cdm::PolygonSoup& soup, std::vector<vtkIdType>& cells)
{
  cdm::Status status = CheckSurface(input);
  const vtkIdType corners = input->GetPolys()->GetNumberOfConnectivityIds() +
    3 * input->GetStrips()->GetNumberOfConnectivityIds();
  if (status.IsOk())
  {
    status = cdm::CheckIdRange(corners, "polygon corners");
  }
  if (status.IsOk())
  {
    status = ToVectors(input->GetPoints(), soup.Points);
  }
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<cdm::Id> wrong;
  vtkIdType cell = GetFirstPolygon(input);
  vtkNew<vtkIdList> ids;
  auto addCells = [&](vtkCellArray* array, auto addCell)
  {
    auto iterator = vtk::TakeSmartPointer(array->NewIterator());
    for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
    {
      iterator->GetCurrentCell(ids);
      if (UsesMissingPoints(ids->GetNumberOfIds(), ids->GetPointer(0), input->GetNumberOfPoints()))
      {
        wrong.push_back(static_cast<cdm::Id>(cell));
      }
      addCell(ids->GetNumberOfIds(), ids->GetPointer(0));
      ++cell;
    }
  };
  addCells(input->GetPolys(),
    [&](vtkIdType size, const vtkIdType* polygon)
    {
      AddPolygon(soup, size, polygon);
      cells.push_back(cell);
    });
  addCells(input->GetStrips(),
    [&](vtkIdType size, const vtkIdType* strip)
    {
      for (vtkIdType i = 0; i + 2 < size; ++i)
      {
        const vtkIdType odd = i % 2;
        const vtkIdType triangle[3] = { strip[i], strip[i + 1 + odd], strip[i + 2 - odd] };
        AddPolygon(soup, 3, triangle);
        cells.push_back(cell);
      }
    });
  if (!wrong.empty())
  {
    return MissingPoints(std::move(wrong));
  }
  return ToLabels(input, cells, soup.Labels);
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToTriangleMesh(vtkPolyData* input, cdm::TriangleMesh& surface)
{
  cdm::Status status = CheckSurface(input);
  if (status.IsOk())
  {
    status = ToVectors(input->GetPoints(), surface.Points);
  }
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<cdm::Id> notTriangles;
  std::vector<cdm::Id> missingPoints;
  std::vector<vtkIdType> cells;
  vtkIdType cell = GetFirstPolygon(input);
  vtkNew<vtkIdList> ids;
  auto iterator = vtk::TakeSmartPointer(input->GetPolys()->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    iterator->GetCurrentCell(ids);
    const vtkIdType* corner = ids->GetPointer(0);
    if (ids->GetNumberOfIds() != 3)
    {
      notTriangles.push_back(static_cast<cdm::Id>(cell));
    }
    else if (UsesMissingPoints(3, corner, input->GetNumberOfPoints()))
    {
      missingPoints.push_back(static_cast<cdm::Id>(cell));
    }
    else
    {
      surface.Triangles.push_back({ static_cast<cdm::Id>(corner[0]),
        static_cast<cdm::Id>(corner[1]), static_cast<cdm::Id>(corner[2]) });
    }
    cells.push_back(cell++);
  }
  for (vtkIdType strip = 0; strip < input->GetNumberOfStrips(); ++strip)
  {
    notTriangles.push_back(static_cast<cdm::Id>(cell++));
  }
  if (!notTriangles.empty())
  {
    return cdm::Status::InvalidInput("The surface has cells that are not triangles. Run "
                                     "vtkBoundaryTriangulator first.",
      std::move(notTriangles));
  }
  if (!missingPoints.empty())
  {
    return MissingPoints(std::move(missingPoints));
  }
  return ToLabels(input, cells, surface.Labels);
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToPoints(vtkPointSet* input, const char* name, std::vector<cdm::Vec3>& points)
{
  cdm::Status status = CheckArrays(input);
  if (status.IsOk())
  {
    status = ToVectors(input->GetPoints(), points);
  }
  const auto wrong = std::find_if_not(points.begin(), points.end(), cdm::IsFinite);
  if (status.IsOk() && wrong != points.end())
  {
    // Not in Status::Points, which are points of the surface.
    status = cdm::Status::InvalidInput("Point " + std::to_string(wrong - points.begin()) +
      " of the " + name + " has coordinates that are not finite: remove or correct it.");
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToFlags(vtkUnstructuredGrid* input, const char* name, std::vector<char>& flags)
{
  vtkDataArray* array = input->GetPointData()->GetArray(name);
  if (!array)
  {
    return {};
  }
  if (array->GetNumberOfComponents() != 1 ||
    array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    return cdm::Status::InvalidInput(std::string("The point array ") + name +
      " needs one component and one value for each point: correct or remove it.");
  }
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    flags.push_back(array->GetComponent(i, 0) != 0.0);
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToSeeds(vtkPointSet* input, std::vector<cdm::RegionSeed>& seeds)
{
  std::vector<cdm::Vec3> points;
  cdm::Status status = ToPoints(input, "seeds", points);
  if (!status.IsOk())
  {
    return status;
  }
  vtkDataArray* regions = input->GetPointData()->GetArray(RegionIdName);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    cdm::RegionSeed seed{ points[i], static_cast<cdm::Id>(i) };
    const double region =
      regions ? regions->GetComponent(static_cast<vtkIdType>(i), 0) : static_cast<double>(i);
    if (!ToRegion(region, seed.Region) || seed.Region < 0)
    {
      return cdm::Status::InvalidInput("The point array RegionId of the seeds must hold whole "
                                       "numbers from 0 on; its value at seed " +
        std::to_string(i) + " is " + std::to_string(region) + ".");
    }
    seeds.push_back(seed);
  }
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToTetrahedra(
  vtkUnstructuredGrid* input, cdm::TetMesh& mesh, std::vector<vtkIdType>& cells)
{
  const vtkIdType count = input->GetNumberOfCells();
  cdm::Status status = cdm::CheckNumberOfTetrahedra(count);
  if (status.IsOk())
  {
    status = cdm::CheckIdRange(input->GetNumberOfPoints(), "points");
  }
  if (status.IsOk())
  {
    status = CheckArrays(input);
  }
  if (!status.IsOk())
  {
    return status;
  }
  vtkDataArray* regions = input->GetCellData()->GetArray(RegionIdName);
  mesh = {};
  struct Block
  {
    std::size_t Begin = 0;
    std::size_t Tetrahedra = 0;
    std::vector<cdm::Id> NotTetrahedra;
    std::vector<cdm::Id> MissingPoints;
    std::vector<cdm::Id> WrongRegions;
  };
  const cdm::ParallelLoopOptions loop{ GetNumberOfThreads(), std::size_t(1) << 14 };
  std::vector<Block> blocks(cdm::GetNumberOfBlocks(count, loop));
  const auto countBlock = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t cell = begin; cell < end; ++cell)
    {
      const int type = input->GetCellType(static_cast<vtkIdType>(cell));
      blocks[block].Tetrahedra += type == VTK_TETRA;
      if (type != VTK_TETRA && GetCellDimension(type) > 2)
      {
        blocks[block].NotTetrahedra.push_back(static_cast<cdm::Id>(cell));
      }
    }
  };
  cdm::ParallelLoop(count, loop, {}, "", countBlock);
  std::size_t numberOfTetrahedra = 0;
  for (Block& block : blocks)
  {
    block.Begin = numberOfTetrahedra;
    numberOfTetrahedra += block.Tetrahedra;
  }
  mesh.Tetrahedra.resize(numberOfTetrahedra);
  mesh.Regions.resize(numberOfTetrahedra, 0);
  cells.resize(numberOfTetrahedra);
  const auto convertBlock = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    vtkNew<vtkIdList> ids;
    std::size_t tetrahedron = blocks[block].Begin;
    for (std::size_t i = begin; i < end; ++i)
    {
      const auto cell = static_cast<vtkIdType>(i);
      if (input->GetCellType(cell) != VTK_TETRA)
      {
        continue;
      }
      input->GetCellPoints(cell, ids);
      cells[tetrahedron] = cell;
      std::copy_n(ids->GetPointer(0), 4, mesh.Tetrahedra[tetrahedron].begin());
      if (UsesMissingPoints(4, ids->GetPointer(0), input->GetNumberOfPoints()))
      {
        blocks[block].MissingPoints.push_back(static_cast<cdm::Id>(cell));
      }
      cdm::Id& region = mesh.Regions[tetrahedron];
      if (regions && (!ToRegion(regions->GetComponent(cell, 0), region) || region < 0))
      {
        blocks[block].WrongRegions.push_back(static_cast<cdm::Id>(cell));
      }
      ++tetrahedron;
    }
  };
  cdm::ParallelLoop(count, loop, {}, "", convertBlock);
  std::vector<cdm::Id> notTetrahedra;
  std::vector<cdm::Id> missingPoints;
  std::vector<cdm::Id> wrongRegions;
  for (const Block& block : blocks)
  {
    const auto append = [](std::vector<cdm::Id>& all, const std::vector<cdm::Id>& some)
    { all.insert(all.end(), some.begin(), some.end()); };
    append(notTetrahedra, block.NotTetrahedra);
    append(missingPoints, block.MissingPoints);
    append(wrongRegions, block.WrongRegions);
  }
  if (!notTetrahedra.empty())
  {
    return NotTetrahedra(std::move(notTetrahedra));
  }
  if (!missingPoints.empty())
  {
    return MissingPoints(std::move(missingPoints));
  }
  if (!wrongRegions.empty())
  {
    return cdm::Status::InvalidInput(
      "The cell array RegionId holds values that are no whole numbers from 0 on.",
      std::move(wrongRegions));
  }
  if (cells.empty())
  {
    return cdm::Status::InvalidInput(count == 0
        ? "The input is empty: it has no cells."
        : "The input has no tetrahedra. Choose a tetrahedral mesh.");
  }
  status = ToVectors(input->GetPoints(), mesh.Points);
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    if (!cdm::IsFinite(mesh.Points[i]))
    {
      status.Points.push_back(static_cast<cdm::Id>(i));
    }
  }
  if (!status.Points.empty())
  {
    return cdm::Status::InvalidInput(
      "Points have coordinates that are not finite: remove or correct them.", {}, status.Points);
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status ToTetMesh(vtkUnstructuredGrid* input, cdm::TetMesh& mesh)
{
  std::vector<vtkIdType> cells;
  const cdm::Status status = ToTetrahedra(input, mesh, cells);
  const vtkIdType count = input->GetNumberOfCells();
  if (status.IsOk() && static_cast<vtkIdType>(cells.size()) == count)
  {
    return cdm::BuildNeighbors(mesh, GetNumberOfThreads());
  }
  std::vector<cdm::Id> others;
  for (vtkIdType cell = 0; cell < std::min<vtkIdType>(count, cdm::LargestId); ++cell)
  {
    if (input->GetCellType(cell) != VTK_TETRA)
    {
      others.push_back(static_cast<cdm::Id>(cell));
    }
  }
  return others.empty() ? status : NotTetrahedra(std::move(others));
}

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
  const cdm::Status status = CheckArrays(input);
  if (!status.IsOk())
  {
    return status;
  }
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
    if (!isGood || !(std::min({ lengths[0], lengths[1], lengths[2] }) > 0.0))
    {
      return cdm::Status::InvalidInput(std::string("The point array Sizing must be positive and "
                                                   "finite, and a tensor symmetric") +
        "; its value at point " + std::to_string(i) + " of the sizing input is " +
        ListValues(tuple, components) + ".");
    }
  }
  const auto interpolator = std::make_shared<const SizingInterpolator>(input, values);
  sizing = [interpolator](const cdm::Vec3& position) { return (*interpolator)(position); };
  return {};
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
  cells.Points.resize(count);
  ForEach(cells.Points.size(),
    [&](std::size_t i)
    {
      double x[3];
      input->GetPoint(static_cast<vtkIdType>(i), x);
      cells.Points[i] = { x[0], x[1], x[2] };
    });
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

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkPoints> FromPoints(const std::vector<cdm::Vec3>& points)
{
  auto output = vtkSmartPointer<vtkPoints>::New();
  output->SetDataTypeToDouble();
  output->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  double* const coordinates = vtkDoubleArray::SafeDownCast(output->GetData())->GetPointer(0);
  ForEach(points.size(),
    [&](std::size_t i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        coordinates[3 * i + axis] = points[i][axis];
      }
    });
  return output;
}

//--------------------------------------------------------------------------------------------------
void FromTriangleMesh(const cdm::TriangleMesh& surface, vtkPolyData* output)
{
  output->SetPoints(FromPoints(surface.Points));
  const auto count = static_cast<vtkIdType>(surface.Triangles.size());
  output->SetPolys(
    MakeCells(count, 3, [&](std::size_t i, int j) { return surface.Triangles[i][j]; }));
  if (!surface.Labels.empty())
  {
    vtkNew<vtkIntArray> labels;
    labels->SetName(BoundaryLabelsName);
    labels->SetNumberOfComponents(2);
    labels->SetNumberOfTuples(count);
    for (vtkIdType i = 0; i < count; ++i)
    {
      labels->SetTypedComponent(i, 0, surface.Labels[i].Front);
      labels->SetTypedComponent(i, 1, surface.Labels[i].Back);
    }
    output->GetCellData()->AddArray(labels);
  }
}

//--------------------------------------------------------------------------------------------------
void FromTetMesh(const cdm::TetMesh& mesh, vtkUnstructuredGrid* output)
{
  output->SetPoints(FromPoints(mesh.Points));
  const std::size_t count = mesh.Tetrahedra.size();
  output->SetCells(
    VTK_TETRA, MakeCells(count, 4, [&](std::size_t i, int j) { return mesh.Tetrahedra[i][j]; }));
  output->GetCellData()->SetScalars(
    MakeArray<vtkIntArray>(RegionIdName, count, [&](std::size_t i) { return mesh.Regions[i]; }));
}

//--------------------------------------------------------------------------------------------------
void FromStructuralEdges(
  const std::vector<cdm::StructuralEdge>& edges, vtkPolyData* surface, vtkPolyData* output)
{
  const auto count = static_cast<vtkIdType>(edges.size());
  vtkNew<vtkCellArray> lines;
  lines->AllocateExact(count, 2 * count);
  vtkNew<vtkIntArray> kinds;
  kinds->SetName("Kind");
  vtkNew<vtkDoubleArray> angles;
  angles->SetName("DihedralAngle");
  vtkNew<vtkIntArray> chains;
  chains->SetName("ChainId");
  PointSelection selection(surface->GetNumberOfPoints());
  for (const cdm::StructuralEdge& edge : edges)
  {
    const vtkIdType ids[2] = { selection.Add(edge.Points[0]), selection.Add(edge.Points[1]) };
    lines->InsertNextCell(2, ids);
    kinds->InsertNextValue(static_cast<int>(edge.Kind));
    angles->InsertNextValue(edge.DihedralAngle);
    chains->InsertNextValue(edge.Chain);
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> surfacePoints;
  surfacePoints->SetName(SurfacePointIdName);
  for (vtkIdType source : selection.GetSources())
  {
    points->InsertNextPoint(surface->GetPoint(source));
    surfacePoints->InsertNextValue(source);
  }
  output->SetPoints(points);
  output->SetLines(lines);
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ kinds.Get(), angles.Get(), chains.Get() })
  {
    output->GetCellData()->AddArray(array);
  }
  output->GetCellData()->SetScalars(kinds);
  CopyTuples(surface->GetPointData(), selection.GetSources(), output->GetPointData(),
    { SurfacePointIdName });
  output->GetPointData()->AddArray(surfacePoints);
}

//--------------------------------------------------------------------------------------------------
void FromFront(const std::vector<cdm::TriangleIds>& front, const std::vector<cdm::Vec3>& points,
  vtkPolyData* output)
{
  PointSelection selection(points.size());
  vtkNew<vtkCellArray> cells;
  for (const cdm::TriangleIds& triangle : front)
  {
    const vtkIdType ids[3] = { selection.Add(triangle[0]), selection.Add(triangle[1]),
      selection.Add(triangle[2]) };
    cells->InsertNextCell(3, ids);
  }
  std::vector<cdm::Vec3> used;
  for (vtkIdType source : selection.GetSources())
  {
    used.push_back(points[source]);
  }
  output->SetPoints(FromPoints(used));
  output->SetPolys(cells);
}

//--------------------------------------------------------------------------------------------------
void FromKeptPoints(vtkPointSet* input, const std::vector<cdm::Id>& sources, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  for (cdm::Id source : sources)
  {
    const vtkIdType id = points->InsertNextPoint(input->GetPoint(source));
    vertices->InsertNextCell(1, &id);
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  if (input)
  {
    CopyTuples(input->GetPointData(), { sources.begin(), sources.end() }, output->GetPointData());
  }
}

//--------------------------------------------------------------------------------------------------
void CopyTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  vtkDataSetAttributes* to, const std::vector<const char*>& except)
{
  // Apart from the output, which others would copy with the flags of CopyFieldOff().
  vtkNew<vtkDataSetAttributes> copied;
  for (const char* name : except)
  {
    copied->CopyFieldOff(name);
  }
  const auto count = static_cast<vtkIdType>(sources.size());
  copied->CopyAllocate(from, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (sources[i] >= 0)
    {
      copied->CopyData(from, sources[i], i);
    }
    else
    {
      copied->NullData(i);
    }
  }
  to->PassData(copied);
}

//--------------------------------------------------------------------------------------------------
void CopyCellTuples(vtkPolyData* from, const std::vector<vtkIdType>& sources, vtkPolyData* to)
{
  CopyTuples(from->GetCellData(), sources, to->GetCellData(), { BoundaryLabelsName });
}

//--------------------------------------------------------------------------------------------------
void CopyTriangleTuples(vtkPolyData* from, const std::vector<cdm::Id>& sources, vtkPolyData* to)
{
  const vtkIdType first = GetFirstPolygon(from);
  std::vector<vtkIdType> cells(sources.size());
  std::transform(sources.begin(), sources.end(), cells.begin(),
    [first](cdm::Id source) { return source == cdm::NoId ? -1 : first + source; });
  CopyCellTuples(from, cells, to);
}

//--------------------------------------------------------------------------------------------------
void InterpolateTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& sources,
  const std::vector<cdm::PointParents>& newPoints, ParentIds parentIds, vtkDataSetAttributes* to)
{
  const auto count = static_cast<vtkIdType>(sources.size());
  vtkNew<vtkIdList> ids;
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* source = from->GetAbstractArray(i);
    const int attribute = from->IsArrayAnAttribute(i);
    if (attribute == vtkDataSetAttributes::GLOBALIDS ||
      attribute == vtkDataSetAttributes::PEDIGREEIDS)
    {
      continue;
    }
    auto target = vtk::TakeSmartPointer(source->NewInstance());
    target->SetName(source->GetName());
    target->SetNumberOfComponents(source->GetNumberOfComponents());
    target->CopyComponentNames(source);
    target->SetNumberOfTuples(count + static_cast<vtkIdType>(newPoints.size()));
    for (vtkIdType j = 0; j < count; ++j)
    {
      target->SetTuple(j, sources[j], source);
    }
    // Parents in the output may be new points themselves: the array is then its own source.
    vtkAbstractArray* parentArray = parentIds == ParentIds::Input ? source : target.Get();
    for (std::size_t j = 0; j < newPoints.size(); ++j)
    {
      const cdm::PointParents& parents = newPoints[j];
      const auto number = std::count_if(
        parents.Ids.begin(), parents.Ids.end(), [](cdm::Id id) { return id != cdm::NoId; });
      ids->SetNumberOfIds(number);
      std::copy_n(parents.Ids.begin(), number, ids->GetPointer(0));
      target->InterpolateTuple(count + static_cast<vtkIdType>(j), ids, parentArray,
        const_cast<double*>(parents.Weights.data()));
    }
    const int index = to->AddArray(target);
    if (attribute >= 0)
    {
      to->SetActiveAttribute(index, attribute);
    }
  }
}

//--------------------------------------------------------------------------------------------------
void InterpolateTuplesInCells(
  vtkUnstructuredGrid* input, const std::vector<cdm::Id>& sources, vtkUnstructuredGrid* output)
{
  vtkPointData* from = input->GetPointData();
  vtkPointData* to = output->GetPointData();
  to->CopyAllOff(vtkDataSetAttributes::INTERPOLATE);
  to->CopyAllOn(vtkDataSetAttributes::INTERPOLATE);
  to->SetCopyGlobalIds(0, vtkDataSetAttributes::INTERPOLATE);
  to->SetCopyPedigreeIds(0, vtkDataSetAttributes::INTERPOLATE);
  to->CopyFieldOff(FreePointName);
  const auto count = static_cast<vtkIdType>(sources.size());
  to->InterpolateAllocate(from, count);
  if (to->GetNumberOfArrays() == 0)
  {
    return;
  }
  // A copy of its own: locators build caches in the data set that they search.
  vtkNew<vtkUnstructuredGrid> cells;
  cells->ShallowCopy(input);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(cells);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (sources[i] != cdm::NoId)
    {
      to->CopyData(from, sources[i], i);
      continue;
    }
    double x[3];
    double nearest[3];
    double parametric[3];
    double weights[4];
    double distance2 = 0.0;
    int subId = 0;
    vtkIdType found = -1;
    output->GetPoint(i, x);
    // On the boundary rounding decides whether a position is inside: the nearest cell is right.
    locator->FindClosestPoint(x, nearest, cell, found, subId, distance2);
    cell->EvaluatePosition(nearest, nullptr, subId, parametric, distance2, weights);
    to->InterpolatePoint(from, i, cell->GetPointIds(), weights);
  }
}

//--------------------------------------------------------------------------------------------------
void AppendTuples(vtkDataSetAttributes* first, vtkDataSetAttributes* second,
  const std::vector<cdm::Id>& sources, vtkDataSetAttributes* to)
{
  const bool hasSecond = second && !sources.empty();
  vtkDataSetAttributes::FieldList fields;
  fields.IntersectFieldList(first);
  if (hasSecond)
  {
    fields.IntersectFieldList(second);
  }
  const vtkIdType count = first->GetNumberOfTuples();
  fields.CopyAllocate(
    to, vtkDataSetAttributes::COPYTUPLE, count + static_cast<vtkIdType>(sources.size()), 0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    fields.CopyData(0, first, i, to, i);
  }
  for (std::size_t i = 0; hasSecond && i < sources.size(); ++i)
  {
    fields.CopyData(1, second, sources[i], to, count + static_cast<vtkIdType>(i));
  }
}
} // namespace vtkCoreBridge
