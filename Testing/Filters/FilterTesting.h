// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FilterTesting.h
 * @brief What the tests of the filters share: small polygon inputs, and an ear for their events.
 *
 * All inputs carry the point array Linear, a linear function of the position (so its interpolation
 * is known), and the cell array PolygonId, the cell's own id.
 */
#ifndef FilterTesting_h
#define FilterTesting_h

#include <vtkAlgorithm.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTetra.h>
#include <vtkTriangle.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace testing_filters
{
using Point = std::array<double, 3>;

inline double Linear(const double x[3])
{
  return 1.0 + 2.0 * x[0] - 3.0 * x[1] + 0.5 * x[2];
}

/** Polygons with one label pair each, if there are labels. */
class SurfaceBuilder
{
public:
  vtkIdType AddPoint(double x, double y, double z)
  {
    this->Points.push_back({ x, y, z });
    return static_cast<vtkIdType>(this->Points.size()) - 1;
  }
  void AddPolygon(std::vector<vtkIdType> ids, int front = -1, int back = 0)
  {
    this->Polygons.push_back(std::move(ids));
    this->Labels.push_back({ front, back });
  }
  /** The six outward sides of a box on points of its own; without a side: 0 to 5. */
  void AddBox(const Point& low, const Point& high, int front = -1, int back = 0, int without = -1)
  {
    static const int sides[6][4] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
      { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
    vtkIdType first = 0;
    for (int i = 0; i < 8; ++i)
    {
      const vtkIdType id = this->AddPoint(
        i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
      first = i == 0 ? id : first;
    }
    for (int side = 0; side < 6; ++side)
    {
      if (side != without)
      {
        this->AddPolygon({ first + sides[side][0], first + sides[side][1], first + sides[side][2],
                           first + sides[side][3] },
          front, back);
      }
    }
  }
  vtkSmartPointer<vtkPolyData> Build(bool withLabels = false) const
  {
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkDoubleArray> linear;
    linear->SetName("Linear");
    for (const Point& point : this->Points)
    {
      points->InsertNextPoint(point.data());
      linear->InsertNextValue(Linear(point.data()));
    }
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkIntArray> ids;
    ids->SetName("PolygonId");
    vtkNew<vtkIntArray> labels;
    labels->SetName("BoundaryLabels");
    labels->SetNumberOfComponents(2);
    for (std::size_t i = 0; i < this->Polygons.size(); ++i)
    {
      cells->InsertNextCell(
        static_cast<vtkIdType>(this->Polygons[i].size()), this->Polygons[i].data());
      ids->InsertNextValue(static_cast<int>(i));
      labels->InsertNextTypedTuple(this->Labels[i].data());
    }
    surface->SetPoints(points);
    surface->SetPolys(cells);
    surface->GetPointData()->AddArray(linear);
    surface->GetCellData()->AddArray(ids);
    if (withLabels)
    {
      surface->GetCellData()->AddArray(labels);
    }
    return surface;
  }

private:
  std::vector<Point> Points;
  std::vector<std::vector<vtkIdType>> Polygons;
  std::vector<std::array<int, 2>> Labels;
};

/** The unit cube. */
inline vtkSmartPointer<vtkPolyData> MakeCube(bool withLabels = false)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  return builder.Build(withLabels);
}

/** Two boxes of volumes 1 and 2, regions 3 and 7, that share the square x = 1 (polygon 5). */
inline vtkSmartPointer<vtkPolyData> MakeTwoBoxes(bool withLabels = false)
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, -1, 3, 5);
  builder.AddPolygon({ 1, 3, 7, 5 }, 7, 3);
  builder.AddBox({ 1, 0, 0 }, { 3, 1, 1 }, -1, 7, 4);
  return builder.Build(withLabels);
}

/** The cube of edge length 3 with a cubic cavity of edge length 1, volume 26. */
inline vtkSmartPointer<vtkPolyData> MakeCubeWithCavity()
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 3, 3, 3 }, -1, 0);
  builder.AddBox({ 1, 1, 1 }, { 2, 2, 2 }, 0, -1);
  return builder.Build(true);
}

/** Two boxes that cross each other: every side of one is cut by the other or inside of it. */
inline vtkSmartPointer<vtkPolyData> MakeCrossingBoxes()
{
  SurfaceBuilder builder;
  builder.AddBox({ 0, 0, 0 }, { 1, 1, 1 });
  builder.AddBox({ 0.5, 0.25, 0.25 }, { 1.5, 0.75, 0.75 });
  return builder.Build();
}

/** The cube with one coordinate of point 6 not a number. */
inline vtkSmartPointer<vtkPolyData> MakeCubeWithNaN()
{
  auto cube = MakeCube();
  cube->GetPoints()->SetPoint(6, 0.0, std::numeric_limits<double>::quiet_NaN(), 1.0);
  return cube;
}

/** A single square: it encloses nothing. */
inline vtkSmartPointer<vtkPolyData> MakeSquare()
{
  SurfaceBuilder builder;
  builder.AddPoint(0, 0, 0);
  builder.AddPoint(1, 0, 0);
  builder.AddPoint(1, 1, 0);
  builder.AddPoint(0, 1, 0);
  builder.AddPolygon({ 0, 1, 2, 3 });
  return builder.Build();
}

inline vtkSmartPointer<vtkPolyData> MakePoints(const std::vector<Point>& positions)
{
  SurfaceBuilder builder;
  for (const Point& position : positions)
  {
    builder.AddPoint(position[0], position[1], position[2]);
  }
  return builder.Build();
}

/** Records errors, warnings and progress of a filter; asks it to abort at a progress if told so. */
class EventRecorder : public vtkCommand
{
public:
  static EventRecorder* New() { return new EventRecorder; }

  void Watch(vtkAlgorithm* filter)
  {
    for (unsigned long event :
      { vtkCommand::ErrorEvent, vtkCommand::WarningEvent, vtkCommand::ProgressEvent })
    {
      filter->AddObserver(event, this);
    }
    filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this);
  }

  void Execute(vtkObject* caller, unsigned long event, void* callData) override
  {
    auto filter = vtkAlgorithm::SafeDownCast(caller);
    if (!filter)
    {
      return; // the executive repeats that its algorithm failed
    }
    if (event == vtkCommand::ProgressEvent)
    {
      this->Progress.push_back(*static_cast<double*>(callData));
      const char* text = filter->GetProgressText();
      if (text && (this->Texts.empty() || this->Texts.back() != text))
      {
        this->Texts.emplace_back(text);
      }
      if (this->Progress.back() >= this->AbortAt)
      {
        filter->SetAbortExecute(1);
      }
      return;
    }
    std::string& messages = event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings;
    messages += static_cast<const char*>(callData);
  }

  /** All messages but the count of flat tetrahedra, which is no fault of the mesh. */
  std::string GetFaults() const
  {
    const std::string messages = this->Errors + this->Warnings;
    std::string faults;
    for (std::size_t begin = 0; begin < messages.size();)
    {
      // Each message ends with an empty line.
      const std::size_t end = std::min(messages.find("\n\n", begin), messages.size() - 2) + 2;
      const std::string message = messages.substr(begin, end - begin);
      if (message.find("a dihedral angle below 15 degrees") == std::string::npos)
      {
        faults += message;
      }
      begin = end;
    }
    return faults;
  }

  std::string Errors;
  std::string Warnings;
  std::vector<double> Progress;
  std::vector<std::string> Texts;
  double AbortAt = std::numeric_limits<double>::infinity();
};

inline bool Contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/** Progress starts, moves in between, never goes back, and ends with 1. */
inline void ExpectProgress(const EventRecorder* recorder)
{
  int between = 0;
  for (std::size_t i = 0; i < recorder->Progress.size(); ++i)
  {
    between += recorder->Progress[i] > 0.0 && recorder->Progress[i] < 1.0;
    EXPECT_GE(recorder->Progress[i], i ? recorder->Progress[i - 1] : 0.0);
    EXPECT_LE(recorder->Progress[i], 1.0);
  }
  EXPECT_GT(between, 0) << "no progress between 0 and 1";
  EXPECT_FALSE(recorder->Texts.empty());
}

/** The outputs of a filter have neither points nor cells. */
inline void ExpectEmptyOutputs(vtkAlgorithm* filter, int firstPort = 0)
{
  for (int port = firstPort; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    auto output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(port));
    ASSERT_NE(output, nullptr);
    EXPECT_EQ(output->GetNumberOfCells(), 0) << "port " << port;
    EXPECT_EQ(output->GetNumberOfPoints(), 0) << "port " << port;
  }
}

/** Runs a filter that has to fail: one error with all these parts, and empty outputs. */
inline void ExpectFailure(
  vtkAlgorithm* filter, const std::vector<std::string>& parts, int firstEmptyPort = 0)
{
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  filter->RemoveObserver(recorder);
  filter->GetExecutive()->RemoveObserver(recorder);
  EXPECT_FALSE(recorder->Errors.empty()) << "no error";
  for (const std::string& part : parts)
  {
    EXPECT_TRUE(Contains(recorder->Errors, part)) << "no '" << part << "' in:\n"
                                                  << recorder->Errors;
  }
  ExpectEmptyOutputs(filter, firstEmptyPort);
}

/** A numeric array with this name, number of components and type. */
inline vtkDataArray* FindArray(
  vtkDataSetAttributes* attributes, const char* name, int components, int type)
{
  vtkDataArray* array = attributes->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  if (array)
  {
    EXPECT_EQ(array->GetNumberOfComponents(), components) << name;
    EXPECT_EQ(array->GetDataType(), type) << name;
  }
  return array;
}

/** The array Linear has its value at each point, coordinates are in double precision. */
inline void ExpectLinear(vtkPointSet* output, double tolerance = 1e-12)
{
  ASSERT_NE(output->GetPoints(), nullptr);
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  vtkDataArray* linear = FindArray(output->GetPointData(), "Linear", 1, VTK_DOUBLE);
  ASSERT_NE(linear, nullptr);
  ASSERT_EQ(linear->GetNumberOfTuples(), output->GetNumberOfPoints());
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    double x[3];
    output->GetPoint(i, x);
    EXPECT_NEAR(linear->GetComponent(i, 0), Linear(x), tolerance) << "point " << i;
  }
}

/** Those of a field array: names of components, percent-encoded; equal values: pieces of one. */
inline std::vector<std::string> GetTexts(vtkDataObject* data, const char* name)
{
  std::vector<std::string> texts;
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  for (int i = 0; array && i < array->GetNumberOfComponents(); ++i)
  {
    std::string text = array->GetComponentName(i) ? array->GetComponentName(i) : "";
    for (std::size_t at = text.find('%'); at != std::string::npos; at = text.find('%', at + 1))
    {
      text.replace(at, 3, 1, static_cast<char>(std::stoi(text.substr(at + 1, 2), nullptr, 16)));
    }
    texts.resize(std::max<std::size_t>(texts.size(), array->GetComponent(0, i) + 1));
    texts[static_cast<std::size_t>(array->GetComponent(0, i))] += text;
  }
  return texts;
}

/** Sum of the signed volumes of the tetrahedra of a region (-1: of all). */
inline double GetVolume(vtkUnstructuredGrid* grid, int region = -1)
{
  vtkDataArray* regions = grid->GetCellData()->GetArray("RegionId");
  double volume = 0.0;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (region < 0 || regions->GetComponent(cell, 0) == region)
    {
      double x[4][3];
      vtkIdList* ids = grid->GetCell(cell)->GetPointIds();
      for (int i = 0; i < 4; ++i)
      {
        grid->GetPoint(ids->GetId(i), x[i]);
      }
      volume += vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3]);
    }
  }
  return volume;
}

/** Area of the triangles of a surface whose labels are front and back, in either order. */
inline double GetArea(vtkPolyData* surface, int front, int back)
{
  vtkDataArray* labels = surface->GetCellData()->GetArray("BoundaryLabels");
  double area = 0.0;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    const double a = labels->GetComponent(cell, 0);
    const double b = labels->GetComponent(cell, 1);
    if ((a == front && b == back) || (a == back && b == front))
    {
      area += vtkTriangle::SafeDownCast(surface->GetCell(cell))->ComputeArea();
    }
  }
  return area;
}
} // namespace testing_filters

#endif
