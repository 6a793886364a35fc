// SPDX-License-Identifier: BSD-3-Clause
#include "Gmsh/PhysicalGroups.h"

#include "CoreBridge/ArrayNames.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Texts.h"

#include "Core/Basics/SortedIds.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace vtkGmsh
{
namespace
{
constexpr cdm::Id OtherSide = 6;

/** The name of an item in a field array of texts, or <prefix><id>. */
std::string GetName(vtkDataObject* data, const char* arrayName, const char* prefix, cdm::Id id)
{
  const std::vector<std::string> names = vtkCoreBridge::GetTexts(arrayName, data->GetFieldData());
  const auto index = static_cast<std::size_t>(id);
  return index < names.size() && !names[index].empty() ? MakeWord(names[index])
                                                       : prefix + std::to_string(id);
}

class Collector
{
public:
  Collector(vtkUnstructuredGrid* grid, vtkPolyData* contacts, GroupedMesh& output)
    : Grid(grid), Contacts(contacts), Mesh(output.Mesh), Groups(output.Groups)
  {
  }

  cdm::Status Run(vtkDataSet*& faulty);

private:
  /** A facet where regions end, as its lower region sees it. */
  struct Border
  {
    cdm::TriangleIds Points;
    cdm::Id Low;
    /** The higher region, or OutsideRegion. */
    cdm::Id High;
    cdm::Id LowTetrahedron;
    cdm::Id HighTetrahedron;
  };
  using Key = std::tuple<int, cdm::Id, cdm::Id>;

  void CollectBorders();
  cdm::Status MatchContacts();
  void CollectGroups();
  void AddContacts(const std::map<cdm::Id, std::vector<Border>>& contacts);
  std::vector<cdm::Id> GetRegions(int kind, cdm::Id first, cdm::Id second) const;
  cdm::Status NumberGroups();
  void NameGroups();
  cdm::Id FindSide(const cdm::TriangleIds& ids) const;

  vtkUnstructuredGrid* Grid;
  vtkPolyData* Contacts;
  cdm::TetMesh& Mesh;
  std::vector<PhysicalGroup>& Groups;
  std::vector<Border> Borders;
  /** Contact of a facet given by its sorted points. */
  std::map<cdm::TriangleIds, cdm::Id> ContactOfFacet;
  /** The regions that have all facets of a contact; none: a group for each region. */
  std::map<cdm::Id, std::set<cdm::Id>> RegionsOfContact;
  std::map<Key, std::vector<GroupFacet>> Facets;
};

cdm::Status Collector::Run(vtkDataSet*& faulty)
{
  faulty = this->Grid;
  cdm::Status status = vtkCoreBridge::ToTetMesh(this->Grid, this->Mesh);
  if (!status.IsOk())
  {
    return status;
  }
  this->CollectBorders();
  if (this->Contacts)
  {
    faulty = this->Contacts;
    status = this->MatchContacts();
  }
  if (status.IsOk())
  {
    this->CollectGroups();
    faulty = this->Grid;
    status = this->NumberGroups();
  }
  if (status.IsOk())
  {
    this->NameGroups();
  }
  return status;
}

void Collector::CollectBorders()
{
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    const cdm::Id region = this->Mesh.Regions[i];
    for (int facet = 0; facet < 4; ++facet)
    {
      const cdm::Id neighbor = this->Mesh.Neighbors[i][facet];
      const cdm::Id other =
        neighbor == cdm::NoId ? cdm::OutsideRegion : this->Mesh.Regions[neighbor / 4];
      // An interface facet is there once.
      if (other == cdm::OutsideRegion || other > region)
      {
        this->Borders.push_back({ cdm::GetFacet(this->Mesh.Tetrahedra[i], facet), region, other,
          static_cast<cdm::Id>(i), neighbor == cdm::NoId ? cdm::NoId : neighbor / 4 });
      }
    }
  }
}

cdm::Status Collector::MatchContacts()
{
  vtkDataArray* ids = this->Contacts->GetCellData()->GetArray("ContactId");
  if (!ids || ids->GetNumberOfComponents() != 1)
  {
    return cdm::Status::InvalidInput(
      "The contacts (port 1) have no cell array ContactId with one whole number for each cell.");
  }
  std::map<cdm::Vec3, cdm::Id> pointIds;
  std::set<cdm::TriangleIds> borders;
  for (const Border& border : this->Borders)
  {
    borders.insert(cdm::Sorted(border.Points));
    for (const cdm::Id point : border.Points)
    {
      pointIds[this->Mesh.Points[point]] = point;
    }
  }
  std::vector<cdm::Id> wrong;
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < this->Contacts->GetNumberOfCells(); ++i)
  {
    const double contact = ids->GetComponent(i, 0);
    if (contact < 0.0)
    {
      continue;
    }
    this->Contacts->GetCellPoints(i, cell);
    cdm::TriangleIds points{ cdm::NoId, cdm::NoId, cdm::NoId };
    for (vtkIdType j = 0; j < cell->GetNumberOfIds() && cell->GetNumberOfIds() == 3; ++j)
    {
      double x[3];
      this->Contacts->GetPoint(cell->GetId(j), x);
      const auto found = pointIds.find({ x[0], x[1], x[2] });
      points[j] = found == pointIds.end() ? cdm::NoId : found->second;
    }
    const bool isId = contact <= std::numeric_limits<cdm::Id>::max() &&
      contact == static_cast<double>(static_cast<cdm::Id>(contact));
    if (borders.count(cdm::Sorted(points)) == 0 || !isId)
    {
      wrong.push_back(static_cast<cdm::Id>(i));
      continue;
    }
    this->ContactOfFacet[cdm::Sorted(points)] = static_cast<cdm::Id>(contact);
  }
  return wrong.empty() ? cdm::Status()
                       : cdm::Status::InvalidInput(
                           "Contact cells are no facets of the mesh's boundary and interfaces, or "
                           "their ContactId is no whole number. Take the cells from the boundary "
                           "that the mesher gives out.",
                           wrong);
}

cdm::Id Collector::FindSide(const cdm::TriangleIds& ids) const
{
  double bounds[6];
  this->Grid->GetBounds(bounds);
  for (int side = 0; side < 6; ++side)
  {
    const bool isOn = std::all_of(ids.begin(), ids.end(),
      [&](cdm::Id point) { return this->Mesh.Points[point][side / 2] == bounds[side]; });
    if (isOn)
    {
      return side;
    }
  }
  return OtherSide;
}

void Collector::CollectGroups()
{
  for (const cdm::Id region : this->Mesh.Regions)
  {
    this->Facets[{ PhysicalGroup::Region, region, cdm::NoId }];
  }
  std::map<cdm::Id, std::vector<Border>> contacts;
  for (const Border& border : this->Borders)
  {
    const auto contact = this->ContactOfFacet.find(cdm::Sorted(border.Points));
    const bool isContact = contact != this->ContactOfFacet.end();
    if (isContact)
    {
      contacts[contact->second].push_back(border);
    }
    const bool isOuter = border.High == cdm::OutsideRegion;
    // A side that contacts take completely is here without facets: it keeps its number.
    std::vector<GroupFacet>& facets =
      this->Facets[isOuter ? Key{ PhysicalGroup::Side, border.Low, this->FindSide(border.Points) }
                           : Key{ PhysicalGroup::Interface, border.Low, border.High }];
    if (!isOuter || !isContact)
    {
      facets.push_back({ border.Points, border.LowTetrahedron });
    }
  }
  this->AddContacts(contacts);
}

void Collector::AddContacts(const std::map<cdm::Id, std::vector<Border>>& contacts)
{
  const auto add = [this](cdm::Id contact, cdm::Id region, const Border& border)
  {
    GroupFacet facet{ border.Points, border.LowTetrahedron };
    if (region == border.High)
    {
      std::swap(facet.Points[1], facet.Points[2]);
      facet.Tetrahedron = border.HighTetrahedron;
    }
    this->Facets[{ PhysicalGroup::Contact, contact, region }].push_back(facet);
  };
  for (const auto& [contact, borders] : contacts)
  {
    std::set<cdm::Id> common{ borders[0].Low, borders[0].High };
    common.erase(cdm::OutsideRegion);
    for (const Border& border : borders)
    {
      const std::set<cdm::Id> before = std::move(common);
      common.clear();
      std::copy_if(before.begin(), before.end(), std::inserter(common, common.end()),
        [&](cdm::Id region) { return region == border.Low || region == border.High; });
    }
    this->RegionsOfContact[contact] = common;
    for (const Border& border : borders)
    {
      if (!common.empty())
      {
        add(contact, *common.begin(), border);
        continue;
      }
      add(contact, border.Low, border);
      if (border.High != cdm::OutsideRegion)
      {
        add(contact, border.High, border);
      }
    }
  }
}

std::vector<cdm::Id> Collector::GetRegions(int kind, cdm::Id first, cdm::Id second) const
{
  if (kind == PhysicalGroup::Interface)
  {
    return { first, second };
  }
  if (kind == PhysicalGroup::Contact)
  {
    const std::set<cdm::Id>& common = this->RegionsOfContact.at(first);
    return common.empty() ? std::vector<cdm::Id>{ second }
                          : std::vector<cdm::Id>(common.begin(), common.end());
  }
  return { first };
}

cdm::Status Collector::NumberGroups()
{
  const cdm::Id lastRegion =
    *std::max_element(this->Mesh.Regions.begin(), this->Mesh.Regions.end());
  const std::size_t largest = std::numeric_limits<int>::max();
  if (static_cast<std::size_t>(lastRegion) + 2 + this->Facets.size() > largest)
  {
    return cdm::Status::InvalidInput("RegionId is too large for the numbers of physical groups.");
  }
  int next = lastRegion + 2;
  for (auto& [key, facets] : this->Facets)
  {
    const auto [kind, first, second] = key;
    const bool isRegion = kind == PhysicalGroup::Region;
    const int number = isRegion ? first + 1 : next++;
    if (isRegion || !facets.empty())
    {
      const std::vector<cdm::Id> regions = this->GetRegions(kind, first, second);
      this->Groups.push_back({ kind, first, second, number, regions, {}, std::move(facets) });
    }
  }
  return {};
}

void Collector::NameGroups()
{
  constexpr const char* Sides[] = { "_xmin", "_xmax", "_ymin", "_ymax", "_zmin", "_zmax",
    "_outside" };
  std::set<std::string> taken;
  const auto getRegion = [this](cdm::Id region)
  { return GetName(this->Grid, vtkCoreBridge::RegionNamesName, "region_", region); };
  const auto makeName = [&](const PhysicalGroup& group)
  {
    switch (group.Kind)
    {
      case PhysicalGroup::Region:
        return getRegion(group.First);
      case PhysicalGroup::Interface:
        return getRegion(group.First) + "_" + getRegion(group.Second);
      case PhysicalGroup::Contact:
        return GetName(this->Contacts, vtkCoreBridge::ContactNamesName, "contact_", group.First) +
          (!this->RegionsOfContact.at(group.First).empty() ? "" : "_" + getRegion(group.Second));
      default:
        return getRegion(group.First) + Sides[group.Second];
    }
  };
  // Names that were given come first: they are not changed because of others.
  for (const int kind : { PhysicalGroup::Region, PhysicalGroup::Contact, PhysicalGroup::Interface,
         PhysicalGroup::Side })
  {
    for (PhysicalGroup& group : this->Groups)
    {
      if (group.Kind == kind)
      {
        const std::string base = makeName(group);
        group.Name = base;
        for (int i = 2; !taken.insert(group.Name).second; ++i)
        {
          group.Name = base + "_" + std::to_string(i);
        }
      }
    }
  }
}
} // namespace

std::string MakeWord(const std::string& text)
{
  std::string word = text;
  for (char& character : word)
  {
    const auto code = static_cast<unsigned char>(character);
    character = std::isalnum(code) && code < 128 ? character : '_';
  }
  return word.empty() || !std::isalpha(static_cast<unsigned char>(word[0])) ? "n" + word : word;
}

const PhysicalGroup& GroupedMesh::GetRegion(cdm::Id region) const
{
  return *std::find_if(this->Groups.begin(), this->Groups.end(),
    [region](const auto& group)
    { return group.Kind == PhysicalGroup::Region && group.First == region; });
}

cdm::Status CollectPhysicalGroups(
  vtkUnstructuredGrid* grid, vtkPolyData* contacts, GroupedMesh& output, vtkDataSet*& faulty)
{
  return Collector(grid, contacts, output).Run(faulty);
}
} // namespace vtkGmsh
