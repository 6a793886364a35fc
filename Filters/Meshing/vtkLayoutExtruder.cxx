// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLayoutExtruder.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Texts.h"
#include "Devices/LayeredStructure.h"
#include "Devices/LayoutOverlay.h"
#include "Devices/vtkStructureOutput.h"

#include "Core/Geometry/Box.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

vtkStandardNewMacro(vtkLayoutExtruder);

namespace
{
using cdm::Id;

/** The mask of steps without one. */
constexpr Id NoMask = -1;

struct Step
{
  Id Mask;
  double Bottom;
  double Top;
  Id Region;
};

/** A whole number from -1 on that fits. */
bool ToId(double value, Id& id)
{
  const bool isId =
    value >= -1.0 && value <= std::numeric_limits<Id>::max() && value == std::floor(value);
  id = isId ? static_cast<Id>(value) : cdm::NoId;
  return isId;
}

cdm::Status CheckSteps(const std::vector<std::array<double, 4>>& rows, const std::vector<Id>& masks,
  std::vector<Step>& steps)
{
  if (rows.empty())
  {
    return cdm::Status::InvalidInput("There are no process steps: add some.");
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const auto& [mask, bottom, top, region] = rows[i];
    Step step{ 0, bottom, top, 0 };
    std::ostringstream problem;
    if (!ToId(mask, step.Mask) || !ToId(region, step.Region))
    {
      problem << "mask and region have to be whole numbers from -1 on.";
    }
    else if (!std::isfinite(bottom) || !std::isfinite(top) || !(bottom < top))
    {
      problem << "the top, " << top << ", has to be above the bottom, " << bottom << ".";
    }
    else if (step.Mask != NoMask && std::find(masks.begin(), masks.end(), step.Mask) == masks.end())
    {
      problem << "no polygon is of mask " << step.Mask << ".";
    }
    if (!problem.str().empty())
    {
      return cdm::Status::InvalidInput("Step " + std::to_string(i) + ": " + problem.str());
    }
    steps.push_back(step);
  }
  return {};
}

/** The mask of each polygon, from the cell array Mask. */
cdm::Status GetMasks(
  vtkPolyData* layout, const std::vector<vtkIdType>& cells, std::vector<Id>& masks)
{
  vtkDataArray* array = layout->GetCellData()->GetArray("Mask");
  if (array && array->GetNumberOfComponents() != 1)
  {
    return cdm::Status::InvalidInput("The cell array Mask needs one component.");
  }
  std::vector<Id> wrong;
  for (const vtkIdType cell : cells)
  {
    masks.emplace_back();
    if (array && (!ToId(array->GetComponent(cell, 0), masks.back()) || masks.back() < 0))
    {
      wrong.push_back(static_cast<Id>(masks.size()) - 1);
    }
  }
  return wrong.empty()
    ? cdm::Status{}
    : cdm::Status::InvalidInput("Masks have to be whole numbers from 0 on.", wrong);
}

/** The bounding rectangle of the layout and a margin around it, as the last polygon. */
void AddRectangle(double margin, cdm::PolygonSoup& polygons)
{
  cdm::Box box;
  for (const Id point : polygons.Connectivity)
  {
    box.Add(polygons.Points[point]);
  }
  const double x[2] = { box.Low.X - margin, box.High.X + margin };
  const double y[2] = { box.Low.Y - margin, box.High.Y + margin };
  for (int i = 0; i < 4; ++i)
  {
    polygons.Connectivity.push_back(static_cast<Id>(polygons.Points.size()));
    polygons.Points.push_back({ x[i == 1 || i == 2], y[i / 2], 0.0 });
  }
  polygons.Offsets.push_back(static_cast<Id>(polygons.Connectivity.size()));
}

struct Contact
{
  Id Mask;
  /** Where its height is among those of the steps. */
  Id Level;
};

/** All heights of steps, ascending. */
std::vector<double> FindLevels(const std::vector<Step>& steps)
{
  std::vector<double> levels;
  for (const Step& step : steps)
  {
    levels.insert(levels.end(), { step.Bottom, step.Top });
  }
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

cdm::Status CheckContacts(const std::vector<std::array<double, 2>>& rows,
  const std::vector<Id>& masks, const std::vector<double>& levels, std::vector<Contact>& contacts)
{
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const auto& [mask, height] = rows[i];
    Contact contact{ cdm::NoId, cdm::NoId };
    const auto level = std::find(levels.begin(), levels.end(), height);
    contact.Level = static_cast<Id>(level - levels.begin());
    std::ostringstream problem;
    if (!ToId(mask, contact.Mask))
    {
      problem << "the mask has to be a whole number from -1 on.";
    }
    else if (contact.Mask != NoMask &&
      std::find(masks.begin(), masks.end(), contact.Mask) == masks.end())
    {
      problem << "no polygon is of mask " << contact.Mask << ".";
    }
    else if (level == levels.end())
    {
      problem << "no step begins or ends at the height " << height << ".";
    }
    if (!problem.str().empty())
    {
      return cdm::Status::InvalidInput("Contact " + std::to_string(i) + ": " + problem.str());
    }
    contacts.push_back(contact);
  }
  return {};
}

/** Each contact has to have some polygon. */
cdm::Status CheckContactIds(std::size_t count, const std::vector<Id>& contactIds)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    if (std::find(contactIds.begin(), contactIds.end(), static_cast<Id>(i)) == contactIds.end())
    {
      return cdm::Status::InvalidInput("Contact " + std::to_string(i) +
        ": there is no boundary and no interface at its height over its mask, or later contacts "
        "take all of it.");
    }
  }
  return {};
}

/** masks: of each polygon of the overlay. */
cdm::LayeredStructure Stack(const cdm::LayoutOverlay& overlay, const std::vector<Id>& masks,
  const std::vector<Step>& steps, const std::vector<Contact>& contacts)
{
  const std::vector<double> levels = FindLevels(steps);
  cdm::LayeredStructure structure(2, levels.front());
  for (const cdm::Vec3& point : overlay.Points)
  {
    structure.AddVertex(point.X, point.Y);
  }
  for (const cdm::TriangleIds& ids : overlay.Pieces)
  {
    structure.AddCell({ ids.begin(), ids.end() });
  }
  for (std::size_t layer = 0; layer + 1 < levels.size(); ++layer)
  {
    std::vector<Id> regions;
    for (const std::vector<Id>& polygons : overlay.Polygons)
    {
      Id region = cdm::OutsideRegion;
      for (const Step& step : steps)
      {
        const bool isThere = step.Bottom <= levels[layer] && step.Top >= levels[layer + 1] &&
          std::any_of(polygons.begin(), polygons.end(),
            [&](Id polygon) { return masks[polygon] == step.Mask; });
        region = isThere ? step.Region : region;
      }
      regions.push_back(region);
    }
    structure.AddLayer(levels[layer + 1], std::move(regions));
  }
  for (std::size_t level = 0; level < levels.size(); ++level)
  {
    std::vector<Id> ids(overlay.Polygons.size(), cdm::NoId);
    for (std::size_t i = 0; i < contacts.size(); ++i)
    {
      for (std::size_t piece = 0; piece < ids.size() && contacts[i].Level == static_cast<Id>(level);
           ++piece)
      {
        const std::vector<Id>& polygons = overlay.Polygons[piece];
        const bool isThere = contacts[i].Mask == NoMask ||
          std::any_of(polygons.begin(), polygons.end(),
            [&](Id polygon) { return masks[polygon] == contacts[i].Mask; });
        ids[piece] = isThere ? static_cast<Id>(i) : ids[piece];
      }
    }
    structure.SetContacts(static_cast<Id>(level), std::move(ids));
  }
  return structure;
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkLayoutExtruder::vtkLayoutExtruder() = default;

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::AddStep(double mask, double bottom, double top, double region)
{
  this->Steps.push_back({ mask, bottom, top, region });
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::RemoveAllSteps()
{
  this->Steps.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::AddRegionName(const char* name)
{
  this->RegionNames.emplace_back(name ? name : "");
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::RemoveAllRegionNames()
{
  this->RegionNames.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::AddContact(double mask, double height)
{
  this->Contacts.push_back({ mask, height });
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::RemoveAllContacts()
{
  this->Contacts.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::AddContactName(const char* name)
{
  this->ContactNames.emplace_back(name ? name : "");
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::RemoveAllContactNames()
{
  this->ContactNames.clear();
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
struct vtkLayoutExtruder::Structure
{
  cdm::PolygonSoup Boundary;
  std::vector<Id> FacetIds;
  std::vector<Id> ContactIds;
};

//--------------------------------------------------------------------------------------------------
cdm::Status vtkLayoutExtruder::MakeStructure(vtkPolyData* layout, Structure& structure)
{
  const cdm::ExecutionContext context = vtkCoreBridge::MakeContext(this);
  cdm::PolygonSoup polygons;
  std::vector<vtkIdType> cells;
  std::vector<Id> masks;
  std::vector<Step> steps;
  std::vector<Contact> contacts;
  cdm::LayoutOverlay overlay;
  const auto overlayMasks = [&]
  {
    if (std::any_of(steps.begin(), steps.end(), [](const Step& row) { return row.Mask == NoMask; }))
    {
      AddRectangle(this->Margin, polygons);
      masks.push_back(NoMask);
    }
    return cdm::OverlayPolygons(std::move(polygons), context.Part(0.0, 0.8), overlay);
  };
  const auto stack = [&]
  {
    if (!context.Continue(0.8, "Collecting interfaces"))
    {
      return cdm::Status::Aborted();
    }
    structure.Boundary =
      Stack(overlay, masks, steps, contacts).MakeBoundary(structure.FacetIds, structure.ContactIds);
    return structure.Boundary.GetNumberOfPolygons() > 0
      ? CheckContactIds(contacts.size(), structure.ContactIds)
      : cdm::Status::InvalidInput("The process steps leave nothing.");
  };
  cdm::Status status =
    vtkCoreBridge::ToPolygonSoup(layout, polygons, cells)
      .Then(
        [&]
        {
          return polygons.GetNumberOfPolygons() > 0
            ? GetMasks(layout, cells, masks)
            : cdm::Status::InvalidInput("The layout has no polygons.");
        })
      .Then([&] { return CheckSteps(this->Steps, masks, steps); })
      .Then([&] { return CheckContacts(this->Contacts, masks, FindLevels(steps), contacts); })
      .Then(overlayMasks)
      .Then(stack);
  vtkCoreBridge::MapCells(status.Cells, cells);
  return status;
}

//--------------------------------------------------------------------------------------------------
int vtkLayoutExtruder::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  if (vtkCoreBridge::IsIdleProcess(input, outputVector))
  {
    return 1;
  }
  Structure structure;
  const cdm::Status status = cdm::RunGuarded([&] { return this->MakeStructure(input, structure); });
  if (!status.IsOk())
  {
    return vtkCoreBridge::ReportFailure(this, outputVector, status, input);
  }
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  vtkStructureOutput::SetPolygons(structure.Boundary, structure.FacetIds, output);
  vtkCoreBridge::SetTexts(
    vtkCoreBridge::RegionNamesName, this->RegionNames, output->GetFieldData());
  if (!this->Contacts.empty())
  {
    vtkStructureOutput::AddIds("ContactId", structure.ContactIds, output);
    vtkCoreBridge::SetTexts(
      vtkCoreBridge::ContactNamesName, this->ContactNames, output->GetFieldData());
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkLayoutExtruder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  for (const std::array<double, 4>& row : this->Steps)
  {
    os << indent << "Step: mask " << row[0] << ", bottom " << row[1] << ", top " << row[2]
       << ", region " << row[3] << "\n";
  }
  for (const std::string& name : this->RegionNames)
  {
    os << indent << "RegionName: " << name << "\n";
  }
  for (const std::array<double, 2>& row : this->Contacts)
  {
    os << indent << "Contact: mask " << row[0] << ", height " << row[1] << "\n";
  }
  for (const std::string& name : this->ContactNames)
  {
    os << indent << "ContactName: " << name << "\n";
  }
  os << indent << "Margin: " << this->Margin << "\n";
}
