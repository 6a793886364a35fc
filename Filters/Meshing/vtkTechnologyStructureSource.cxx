// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTechnologyStructureSource.h"

#include "LayeredStructure.h"
#include "vtkCoreBridge.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkTechnologyStructureSource);

namespace
{
using cdm::Id;

/** What a device hands over: its boundary and the names of its regions. */
struct Device
{
  cdm::PolygonSoup Boundary;
  std::vector<Id> FacetIds;
  std::vector<const char*> RegionNames;
};

struct Parameter
{
  const char* Name;
  double Value;
};

std::ostream& operator<<(std::ostream& stream, const Parameter& parameter)
{
  return stream << parameter.Name << " = " << parameter.Value;
}

/** Empty, or what is wrong with these lengths. */
std::string CheckLengths(const std::vector<Parameter>& lengths)
{
  for (const Parameter& length : lengths)
  {
    if (!(length.Value >= 1e-9 && length.Value <= 1e9))
    {
      std::ostringstream problem;
      problem << length << " has to be in the range from 1e-9 to 1e9 micrometres.";
      return problem.str();
    }
  }
  return {};
}

/** Empty, or that the positions do not ascend and which parameters make them. */
std::string CheckAscending(const std::vector<double>& positions, const char* parameters)
{
  for (std::size_t i = 1; i < positions.size(); ++i)
  {
    if (positions[i - 1] >= positions[i])
    {
      return std::string(parameters) +
        " are too different in size: positions made of them coincide in double precision.";
    }
  }
  return {};
}

std::string CheckLess(const Parameter& small, const Parameter& large)
{
  if (small.Value < large.Value)
  {
    return {};
  }
  std::ostringstream problem;
  problem << small << " has to be below " << large << ".";
  return problem.str();
}

struct CosineSine
{
  double Cosine;
  double Sine;
};

/** Exact for multiples of 90 degrees. */
CosineSine GetCosineSine(double degrees)
{
  const double remainder = std::remainder(degrees, 360.0);
  const double angle = std::abs(remainder);
  // Reduce to the first octant, where nothing cancels.
  const double acute = angle > 90.0 ? 180.0 - angle : angle;
  double cosine = std::cos(vtkMath::RadiansFromDegrees(acute));
  double sine = std::sin(vtkMath::RadiansFromDegrees(acute));
  if (acute > 45.0)
  {
    cosine = std::sin(vtkMath::RadiansFromDegrees(90.0 - acute));
    sine = std::cos(vtkMath::RadiansFromDegrees(90.0 - acute));
  }
  return { angle > 90.0 ? -cosine : cosine, remainder < 0.0 ? -sine : sine };
}

struct MosParameters
{
  double GateLength, GateHeight, GateOxideThickness, SpacerWidth;
  double BulkLength, BulkDepth, DeviceWidth;
  int SpacerSegments;
};

std::string MakeMosTransistor(const MosParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "GateLength", p.GateLength },
    { "GateHeight", p.GateHeight }, { "GateOxideThickness", p.GateOxideThickness },
    { "SpacerWidth", p.SpacerWidth }, { "BulkLength", p.BulkLength }, { "BulkDepth", p.BulkDepth },
    { "DeviceWidth", p.DeviceWidth } });
  if (problem.empty())
  {
    problem = CheckLess({ "GateLength + 2 SpacerWidth", p.GateLength + 2.0 * p.SpacerWidth },
      { "BulkLength", p.BulkLength });
  }
  if (!problem.empty())
  {
    return problem;
  }

  // The right half of the cross-section; the left one is its exact mirror image.
  const double gateEdge = 0.5 * p.GateLength;
  const double gateTop = p.GateOxideThickness + p.GateHeight;
  std::vector<double> flankX{ gateEdge };
  std::vector<double> flankZ{ gateTop };
  for (int i = 1; i < p.SpacerSegments; ++i)
  {
    const CosineSine direction = GetCosineSine(90.0 * i / p.SpacerSegments);
    flankX.push_back(gateEdge + p.SpacerWidth * direction.Sine);
    flankZ.push_back(p.GateOxideThickness + p.GateHeight * direction.Cosine);
  }
  flankX.push_back(gateEdge + p.SpacerWidth);
  flankZ.push_back(p.GateOxideThickness);
  std::vector<double> positionsX = flankX;
  positionsX.push_back(0.5 * p.BulkLength);
  problem = CheckAscending(positionsX, "GateLength, SpacerWidth and BulkLength");
  if (problem.empty())
  {
    problem =
      CheckAscending({ flankZ.rbegin(), flankZ.rend() }, "GateOxideThickness and GateHeight");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Bulk,
    GateOxide,
    Gate,
    LeftSpacer,
    RightSpacer
  };
  device.RegionNames = { "Bulk", "GateOxide", "Gate", "LeftSpacer", "RightSpacer" };
  cdm::LayeredStructure structure(1, 0.0);
  const double foot = flankX.back();
  const double bulkEdge = 0.5 * p.BulkLength;
  const Id bulkFootLeft = structure.AddVertex(-foot, 0.0);
  const Id bulkFootRight = structure.AddVertex(foot, 0.0);
  std::vector<Id> bulk{ structure.AddVertex(-bulkEdge, -p.BulkDepth),
    structure.AddVertex(bulkEdge, -p.BulkDepth), structure.AddVertex(bulkEdge, 0.0), bulkFootRight,
    bulkFootLeft, structure.AddVertex(-bulkEdge, 0.0) };

  // A spacer runs from the lower corner of the gate over its foot and up the flank.
  std::vector<Id> spacers[2];
  for (int side = 0; side < 2; ++side)
  {
    const double sign = side == 0 ? -1.0 : 1.0;
    spacers[side].push_back(structure.AddVertex(sign * gateEdge, p.GateOxideThickness));
    for (std::size_t i = flankX.size(); i-- > 0;)
    {
      spacers[side].push_back(structure.AddVertex(sign * flankX[i], flankZ[i]));
    }
  }
  const std::vector<Id>& left = spacers[0];
  const std::vector<Id>& right = spacers[1];
  std::vector<Id> oxide{ bulkFootLeft, bulkFootRight, right[1], right[0], left[0], left[1] };
  std::vector<Id> gate{ left[0], right[0], right.back(), left.back() };

  structure.AddCell(std::move(bulk));
  structure.AddCell(std::move(oxide));
  structure.AddCell(std::move(gate));
  structure.AddCell(std::move(spacers[0]));
  structure.AddCell(std::move(spacers[1]));
  structure.AddLayer(p.DeviceWidth, { Bulk, GateOxide, Gate, LeftSpacer, RightSpacer });
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  return {};
}

struct NmosParameters
{
  double GateLength, GateHeight, GateOxideThickness, BulkLength, BulkDepth, DeviceWidth;
  double ChannelWidth, FieldOxideThickness, CoverOxideThickness;
};

std::string MakeNmosWithFieldOxide(const NmosParameters& p, Device& device)
{
  const double field = 0.5 * p.FieldOxideThickness;
  const double cover = p.CoverOxideThickness;
  const double gateTop = p.GateOxideThickness + p.GateHeight;
  std::string problem = CheckLengths({ { "GateLength", p.GateLength },
    { "GateHeight", p.GateHeight }, { "GateOxideThickness", p.GateOxideThickness },
    { "BulkLength", p.BulkLength }, { "BulkDepth", p.BulkDepth }, { "DeviceWidth", p.DeviceWidth },
    { "ChannelWidth", p.ChannelWidth }, { "FieldOxideThickness", p.FieldOxideThickness },
    { "CoverOxideThickness", p.CoverOxideThickness } });
  const std::pair<Parameter, Parameter> orders[] = {
    { { "GateLength + 2 CoverOxideThickness", p.GateLength + 2.0 * cover },
      { "BulkLength", p.BulkLength } },
    { { "2 CoverOxideThickness", 2.0 * cover }, { "ChannelWidth", p.ChannelWidth } },
    { { "ChannelWidth", p.ChannelWidth }, { "DeviceWidth", p.DeviceWidth } },
    { { "FieldOxideThickness / 2", field }, { "BulkDepth", p.BulkDepth } },
    { { "FieldOxideThickness / 2", field }, { "GateOxideThickness + GateHeight", gateTop } }
  };
  for (const auto& [small, large] : orders)
  {
    problem = problem.empty() ? CheckLess(small, large) : problem;
  }
  const double middle = 0.5 * p.DeviceWidth;
  const double gateEdge = 0.5 * p.GateLength;
  const double channelEdge = 0.5 * p.ChannelWidth;
  const double x[6] = { -0.5 * p.BulkLength, -(gateEdge + cover), -gateEdge, gateEdge,
    gateEdge + cover, 0.5 * p.BulkLength };
  const double y[6] = { 0.0, middle - channelEdge, middle - (channelEdge - cover),
    middle + (channelEdge - cover), middle + channelEdge, p.DeviceWidth };
  std::vector<double> levels{ -field, 0.0, p.GateOxideThickness, gateTop, gateTop + cover, cover,
    field, field + cover };
  if (problem.empty())
  {
    problem = CheckAscending({ x, x + 6 }, "GateLength, CoverOxideThickness and BulkLength");
  }
  if (problem.empty())
  {
    problem = CheckAscending({ y, y + 6 }, "ChannelWidth, CoverOxideThickness and DeviceWidth");
  }
  if (problem.empty())
  {
    problem =
      CheckAscending({ -p.BulkDepth, levels[0], levels[1], levels[2], levels[3], levels[4] },
        "BulkDepth, FieldOxideThickness, GateOxideThickness, GateHeight and CoverOxideThickness");
  }
  if (problem.empty())
  {
    problem =
      CheckAscending({ levels[6], levels[7] }, "FieldOxideThickness and CoverOxideThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  enum Region : Id
  {
    Bulk,
    LeftFieldOxide,
    RightFieldOxide,
    GateOxide,
    Gate,
    CoverOxide
  };
  device.RegionNames = { "Bulk", "LeftFieldOxide", "RightFieldOxide", "GateOxide", "Gate",
    "CoverOxide" };
  // A grid of 5 x 5 cells: the gate is the middle column, the field oxides are the outer rows, and
  // the columns and rows between are as wide as the cover oxide on the walls that they lie at.
  constexpr int side = 5;
  cdm::LayeredStructure structure(2, -p.BulkDepth);
  Id grid[side + 1][side + 1];
  for (int row = 0; row <= side; ++row)
  {
    for (int column = 0; column <= side; ++column)
    {
      grid[row][column] = structure.AddVertex(x[column], y[row]);
    }
  }
  for (int row = 0; row < side; ++row)
  {
    for (int column = 0; column < side; ++column)
    {
      structure.AddCell({ grid[row][column], grid[row][column + 1], grid[row + 1][column + 1],
        grid[row + 1][column] });
    }
  }
  const auto getRegion = [=](int row, int column, double z) -> Id
  {
    const bool isField = row == 0 || row == side - 1;
    const bool isAtGate = column > 0 && column < side - 1;
    const bool isAtField = isField || row == 1 || row == side - 2;
    if (isField && z > -field && z < field)
    {
      return row == 0 ? LeftFieldOxide : RightFieldOxide;
    }
    if (z < 0.0)
    {
      return Bulk;
    }
    if (column == side / 2 && z < gateTop)
    {
      return z < p.GateOxideThickness && !isField ? GateOxide : Gate;
    }
    const double covered = isAtGate ? gateTop : isAtField ? field : 0.0;
    return z < covered + cover ? CoverOxide : cdm::OutsideRegion;
  };
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  double bottom = -p.BulkDepth;
  for (const double top : levels)
  {
    std::vector<Id> regions;
    for (int cell = 0; cell < side * side; ++cell)
    {
      regions.push_back(getRegion(cell / side, cell % side, bottom + 0.5 * (top - bottom)));
    }
    structure.AddLayer(top, std::move(regions));
    bottom = top;
  }
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  return {};
}

struct ViaParameters
{
  double ViaDiameter, ViaHeight, BottomLineWidth, BottomLineThickness;
  double TopLineWidth, TopLineThickness, BoxSize;
  int NumberOfSegments;
};

std::string MakeViaPlug(const ViaParameters& p, Device& device)
{
  std::string problem = CheckLengths({ { "ViaDiameter", p.ViaDiameter },
    { "ViaHeight", p.ViaHeight }, { "BottomLineWidth", p.BottomLineWidth },
    { "BottomLineThickness", p.BottomLineThickness }, { "TopLineWidth", p.TopLineWidth },
    { "TopLineThickness", p.TopLineThickness }, { "BoxSize", p.BoxSize } });
  const Parameter diameter{ "ViaDiameter", p.ViaDiameter };
  const Parameter box{ "BoxSize", p.BoxSize };
  for (const Parameter& line : { Parameter{ "BottomLineWidth", p.BottomLineWidth },
         Parameter{ "TopLineWidth", p.TopLineWidth } })
  {
    problem = problem.empty() ? CheckLess(diameter, line) : problem;
    problem = problem.empty() ? CheckLess(line, box) : problem;
  }
  const double top = p.ViaHeight + p.TopLineThickness;
  if (problem.empty())
  {
    problem = CheckAscending({ p.ViaHeight, top }, "ViaHeight and TopLineThickness");
  }
  if (!problem.empty())
  {
    return problem;
  }

  // The layout of all layers: a grid of 3 x 3 cells, whose middle column is the top line and whose
  // middle row the bottom line; the middle cell is the plug and two cells around it.
  enum Region : Id
  {
    Insulator,
    BottomLine,
    Plug,
    TopLine
  };
  device.RegionNames = { "Insulator", "BottomLine", "Plug", "TopLine" };
  cdm::LayeredStructure structure(2, -p.BottomLineThickness);
  const double x[4] = { -0.5 * p.BoxSize, -0.5 * p.TopLineWidth, 0.5 * p.TopLineWidth,
    0.5 * p.BoxSize };
  const double y[4] = { -0.5 * p.BoxSize, -0.5 * p.BottomLineWidth, 0.5 * p.BottomLineWidth,
    0.5 * p.BoxSize };
  Id grid[4][4];
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      grid[row][column] = structure.AddVertex(x[column], y[row]);
    }
  }
  std::vector<Id> bottom, middle, upper;
  const auto addCell =
    [&](std::vector<Id> outline, bool isInBottomLine, bool isInPlug, bool isInTopLine)
  {
    structure.AddCell(std::move(outline));
    bottom.push_back(isInBottomLine ? BottomLine : Insulator);
    middle.push_back(isInPlug ? Plug : Insulator);
    upper.push_back(isInTopLine ? TopLine : Insulator);
  };
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      if (row != 1 || column != 1)
      {
        addCell({ grid[row][column], grid[row][column + 1], grid[row + 1][column + 1],
                  grid[row + 1][column] },
          row == 1, false, column == 1);
      }
    }
  }

  // Two cuts from opposite corners of the middle cell to the plug's vertices that lie farthest in
  // the direction of these corners cannot meet the plug before.
  const int n = p.NumberOfSegments;
  std::vector<Id> circle;
  std::vector<double> reach;
  for (int i = 0; i < n; ++i)
  {
    const CosineSine direction = GetCosineSine(360.0 * i / n);
    const double u = 0.5 * p.ViaDiameter * direction.Cosine;
    const double v = 0.5 * p.ViaDiameter * direction.Sine;
    circle.push_back(structure.AddVertex(u, v));
    reach.push_back(u + v);
  }
  const auto getIndex = [&reach](std::vector<double>::const_iterator position)
  { return static_cast<int>(position - reach.cbegin()); };
  const int farthest = getIndex(std::max_element(reach.cbegin(), reach.cend()));
  const int nearest = getIndex(std::min_element(reach.cbegin(), reach.cend()));
  std::vector<Id> below{ grid[1][1], grid[1][2], grid[2][2] };
  for (int i = farthest; i != nearest; i = (i + n - 1) % n)
  {
    below.push_back(circle[i]);
  }
  below.push_back(circle[nearest]);
  std::vector<Id> above{ grid[2][2], grid[2][1], grid[1][1] };
  for (int i = nearest; i != farthest; i = (i + n - 1) % n)
  {
    above.push_back(circle[i]);
  }
  above.push_back(circle[farthest]);
  addCell(std::move(below), true, false, true);
  addCell(std::move(above), true, false, true);
  addCell(std::move(circle), true, true, true);

  structure.AddLayer(0.0, std::move(bottom));
  structure.AddLayer(p.ViaHeight, std::move(middle));
  structure.AddLayer(top, std::move(upper));
  device.Boundary = structure.MakeBoundary(device.FacetIds);
  return {};
}

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
  const CosineSine turn = GetCosineSine(angle);
  for (cdm::Vec3& point : points)
  {
    const cdm::Vec3 parallel = cdm::Dot(unit, point) * unit;
    point = parallel + turn.Cosine * (point - parallel) + turn.Sine * cdm::Cross(unit, point);
  }
  return {};
}

void Convert(const Device& device, vtkPolyData* output)
{
  const cdm::PolygonSoup& soup = device.Boundary;
  const vtkIdType numberOfPolygons = soup.GetNumberOfPolygons();
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIntArray> labels;
  labels->SetName(vtkCoreBridge::BoundaryLabelsName);
  labels->SetNumberOfComponents(2);
  labels->SetComponentName(0, "front");
  labels->SetComponentName(1, "back");
  labels->SetNumberOfTuples(numberOfPolygons);
  vtkNew<vtkIntArray> facets;
  facets->SetName("FacetId");
  facets->SetNumberOfTuples(numberOfPolygons);
  for (Id polygon = 0; polygon < numberOfPolygons; ++polygon)
  {
    polygons->InsertNextCell(soup.GetPolygonSize(polygon));
    for (Id i = 0; i < soup.GetPolygonSize(polygon); ++i)
    {
      polygons->InsertCellPoint(soup.GetPolygon(polygon)[i]);
    }
    labels->SetTypedComponent(polygon, 0, soup.Labels[polygon].Front);
    labels->SetTypedComponent(polygon, 1, soup.Labels[polygon].Back);
    facets->SetValue(polygon, device.FacetIds[polygon]);
  }
  vtkNew<vtkStringArray> names;
  names->SetName("RegionNames");
  for (const char* name : device.RegionNames)
  {
    names->InsertNextValue(name);
  }
  output->SetPoints(vtkCoreBridge::FromPoints(soup.Points));
  output->SetPolys(polygons);
  output->GetCellData()->AddArray(labels);
  output->GetCellData()->AddArray(facets);
  output->GetFieldData()->AddArray(names);
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
  Device device;
  std::string problem;
  if (this->Structure == MOS_TRANSISTOR)
  {
    problem = MakeMosTransistor(
      { this->GateLength, this->GateHeight, this->GateOxideThickness, this->SpacerWidth,
        this->BulkLength, this->BulkDepth, this->DeviceWidth, this->SpacerSegments },
      device);
  }
  else if (this->Structure == NMOS_WITH_FIELD_OXIDE)
  {
    problem = MakeNmosWithFieldOxide(
      { this->GateLength, this->GateHeight, this->GateOxideThickness, this->BulkLength,
        this->BulkDepth, this->DeviceWidth, this->ChannelWidth, this->FieldOxideThickness,
        this->CoverOxideThickness },
      device);
  }
  else
  {
    problem = MakeViaPlug(
      { this->ViaDiameter, this->ViaHeight, this->BottomLineWidth, this->BottomLineThickness,
        this->TopLineWidth, this->TopLineThickness, this->BoxSize, this->NumberOfSegments },
      device);
  }
  if (problem.empty() && this->RotationAngle != 0.0)
  {
    problem = Rotate(this->RotationAngle, this->RotationAxis, device.Boundary.Points);
  }
  if (!problem.empty())
  {
    vtkErrorMacro("" << this->GetStructureAsString() << ": " << problem);
    return 0;
  }
  Convert(device, output);
  return 1;
}

const char* vtkTechnologyStructureSource::GetStructureAsString()
{
  static const char* const names[] = { "MosTransistor", "ViaPlug", "NmosWithFieldOxide" };
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
  os << indent << "RotationAngle: " << this->RotationAngle << endl;
  os << indent << "RotationAxis: " << this->RotationAxis[0] << ' ' << this->RotationAxis[1] << ' '
     << this->RotationAxis[2] << endl;
}
