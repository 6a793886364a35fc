// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGmshMeshWriter.h"

#include "CoreBridge/Execution.h"
#include "CoreBridge/Inputs.h"
#include "CoreBridge/Reports.h"
#include "CoreBridge/Texts.h"
#include "vtkConformingDelaunayCompatibility.h"

#include "Core/Basics/SortedIds.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <vtksys/FStream.hxx>

#include <algorithm>
#include <cctype>
#include <locale>
#include <map>
#include <set>
#include <tuple>

vtkStandardNewMacro(vtkGmshMeshWriter);

namespace
{
/** Codes of the format. */
constexpr int TriangleType = 2;
constexpr int TetrahedronType = 4;

/** A physical group; the smaller kind is numbered first. */
struct Group
{
  enum Kinds
  {
    Region,
    Interface,
    Contact,
    Side
  };
  int Kind;
  /** Region; lower region; contact; region. */
  cdm::Id First;
  /** -; higher region; region; side of the bounding box or OtherSide. */
  cdm::Id Second;

  friend bool operator<(const Group& a, const Group& b)
  {
    return std::tie(a.Kind, a.First, a.Second) < std::tie(b.Kind, b.First, b.Second);
  }
};

constexpr cdm::Id OtherSide = 6;

struct Element
{
  Group Owner;
  cdm::TetrahedronIds Points;
};

/** Letters, digits and _, a letter first. */
std::string MakeWord(const std::string& text)
{
  std::string word = text;
  for (char& character : word)
  {
    character = std::isalnum(static_cast<unsigned char>(character)) &&
        static_cast<unsigned char>(character) < 128
      ? character
      : '_';
  }
  return word.empty() || !std::isalpha(static_cast<unsigned char>(word[0])) ? "n" + word : word;
}

/** The name of an item in a field array of texts, or <prefix><id>. */
std::string GetName(vtkDataObject* data, const char* arrayName, const char* prefix, cdm::Id id)
{
  const std::vector<std::string> names = vtkCoreBridge::GetTexts(arrayName, data->GetFieldData());
  const auto index = static_cast<std::size_t>(id);
  return index < names.size() && !names[index].empty() ? MakeWord(names[index])
                                                       : prefix + std::to_string(id);
}

/** Collects the elements of the file from the mesh. */
class GroupCollector
{
public:
  GroupCollector(vtkUnstructuredGrid* grid, vtkPolyData* contacts) : Grid(grid), Contacts(contacts)
  {
  }

  /** faulty receives the input that the status speaks of. */
  cdm::Status Run(vtkDataSet*& faulty);
  void Write(std::ostream& file) const;

private:
  cdm::Status MatchContacts();
  void CollectFacets();
  cdm::Id FindSide(const cdm::TriangleIds& ids) const;
  std::map<Group, std::string> MakeNames() const;

  vtkUnstructuredGrid* Grid;
  vtkPolyData* Contacts;
  cdm::TetMesh Mesh;
  /** Contact of a facet given by its sorted points. */
  std::map<cdm::TriangleIds, cdm::Id> ContactOfFacet;
  std::vector<Element> Facets;
};

cdm::Status GroupCollector::Run(vtkDataSet*& faulty)
{
  faulty = this->Grid;
  cdm::Status status = vtkCoreBridge::ToTetMesh(this->Grid, this->Mesh);
  if (status.IsOk() && this->Contacts)
  {
    status = this->MatchContacts();
    faulty = this->Contacts;
  }
  if (status.IsOk())
  {
    this->CollectFacets();
  }
  return status;
}

cdm::Status GroupCollector::MatchContacts()
{
  vtkDataArray* ids = this->Contacts->GetCellData()->GetArray("ContactId");
  if (!ids || ids->GetNumberOfComponents() != 1)
  {
    return cdm::Status::InvalidInput(
      "The contacts (port 1) have no cell array ContactId with one whole number for each cell.");
  }
  std::map<cdm::Vec3, cdm::Id> pointIds;
  std::set<cdm::TriangleIds> borders;
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    for (int facet = 0; facet < 4; ++facet)
    {
      const cdm::Id neighbor = this->Mesh.Neighbors[i][facet];
      if (neighbor == cdm::NoId || this->Mesh.Regions[neighbor / 4] != this->Mesh.Regions[i])
      {
        const cdm::TriangleIds points = cdm::GetFacet(this->Mesh.Tetrahedra[i], facet);
        borders.insert(cdm::Sorted(points));
        for (const cdm::Id point : points)
        {
          pointIds[this->Mesh.Points[point]] = point;
        }
      }
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
    if (borders.count(cdm::Sorted(points)) == 0 || contact != static_cast<cdm::Id>(contact))
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

cdm::Id GroupCollector::FindSide(const cdm::TriangleIds& ids) const
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

void GroupCollector::CollectFacets()
{
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    const cdm::Id region = this->Mesh.Regions[i];
    for (int facet = 0; facet < 4; ++facet)
    {
      const cdm::Id neighbor = this->Mesh.Neighbors[i][facet];
      const cdm::Id other =
        neighbor == cdm::NoId ? cdm::OutsideRegion : this->Mesh.Regions[neighbor / 4];
      if (other == region)
      {
        continue;
      }
      const cdm::TriangleIds ids = cdm::GetFacet(this->Mesh.Tetrahedra[i], facet);
      const cdm::TetrahedronIds points{ ids[0], ids[1], ids[2], cdm::NoId };
      const auto contact = this->ContactOfFacet.find(cdm::Sorted(ids));
      const bool isContact = contact != this->ContactOfFacet.end();
      if (isContact)
      {
        this->Facets.push_back({ { Group::Contact, contact->second, region }, points });
      }
      // An interface facet is written once.
      if (other > region)
      {
        this->Facets.push_back({ { Group::Interface, region, other }, points });
      }
      else if (other == cdm::OutsideRegion && !isContact)
      {
        this->Facets.push_back({ { Group::Side, region, this->FindSide(ids) }, points });
      }
    }
  }
  std::stable_sort(this->Facets.begin(), this->Facets.end(),
    [](const Element& a, const Element& b) { return a.Owner < b.Owner; });
}

std::map<Group, std::string> GroupCollector::MakeNames() const
{
  std::map<Group, std::string> names;
  std::map<cdm::Id, int> regionsOfContact;
  for (const cdm::Id region : this->Mesh.Regions)
  {
    names[{ Group::Region, region, 0 }];
  }
  for (const Element& facet : this->Facets)
  {
    if (names.count(facet.Owner) == 0 && facet.Owner.Kind == Group::Contact)
    {
      ++regionsOfContact[facet.Owner.First];
    }
    names[facet.Owner];
  }
  std::set<std::string> taken;
  const auto getRegion = [this](cdm::Id region)
  { return GetName(this->Grid, "RegionNames", "region_", region); };
  for (auto& [group, name] : names)
  {
    constexpr const char* Sides[] = { "_xmin", "_xmax", "_ymin", "_ymax", "_zmin", "_zmax",
      "_outside" };
    switch (group.Kind)
    {
      case Group::Region:
        name = getRegion(group.First);
        break;
      case Group::Interface:
        name = getRegion(group.First) + "_" + getRegion(group.Second);
        break;
      case Group::Contact:
        name = GetName(this->Contacts, "ContactNames", "contact_", group.First);
        if (regionsOfContact[group.First] > 1)
        {
          name += "_" + getRegion(group.Second);
        }
        break;
      default:
        name = getRegion(group.First) + Sides[group.Second];
    }
    const std::string base = name;
    for (int i = 2; !taken.insert(name).second; ++i)
    {
      name = base + "_" + std::to_string(i);
    }
  }
  return names;
}

void GroupCollector::Write(std::ostream& file) const
{
  const std::map<Group, std::string> names = this->MakeNames();
  std::map<Group, std::size_t> numbers;
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << names.size() << "\n";
  for (const auto& [group, name] : names)
  {
    const std::size_t number = numbers.size() + 1;
    numbers[group] = number;
    file << (group.Kind == Group::Region ? 3 : 2) << " " << number << " \"" << name << "\"\n";
  }

  // Only points that are used, numbered from one in their order.
  std::vector<std::size_t> nodes(this->Mesh.Points.size(), 0);
  for (const cdm::TetrahedronIds& ids : this->Mesh.Tetrahedra)
  {
    for (const cdm::Id point : ids)
    {
      nodes[point] = 1;
    }
  }
  std::size_t numberOfNodes = 0;
  for (std::size_t& node : nodes)
  {
    node = node == 0 ? 0 : ++numberOfNodes;
  }
  using vtkConformingDelaunayCompatibility::ToText;
  file << "$EndPhysicalNames\n$Nodes\n" << numberOfNodes << "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    if (nodes[i] != 0)
    {
      const cdm::Vec3& p = this->Mesh.Points[i];
      file << nodes[i] << " " << ToText(p.X) << " " << ToText(p.Y) << " " << ToText(p.Z) << "\n";
    }
  }

  std::size_t element = 0;
  const auto write = [&](int type, const Group& group, const cdm::TetrahedronIds& points, int size)
  {
    const std::size_t number = numbers.at(group);
    file << ++element << " " << type << " 2 " << number << " " << number;
    for (int i = 0; i < size; ++i)
    {
      file << " " << nodes[points[i]];
    }
    file << "\n";
  };
  file << "$EndNodes\n$Elements\n" << this->Facets.size() + this->Mesh.Tetrahedra.size() << "\n";
  for (const Element& facet : this->Facets)
  {
    write(TriangleType, facet.Owner, facet.Points, 3);
  }
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    write(
      TetrahedronType, { Group::Region, this->Mesh.Regions[i], 0 }, this->Mesh.Tetrahedra[i], 4);
  }
  file << "$EndElements\n";
}
} // namespace

//--------------------------------------------------------------------------------------------------
vtkGmshMeshWriter::vtkGmshMeshWriter()
{
  this->SetNumberOfInputPorts(2);
}

//--------------------------------------------------------------------------------------------------
vtkGmshMeshWriter::~vtkGmshMeshWriter()
{
  this->SetFileName(nullptr);
}

//--------------------------------------------------------------------------------------------------
int vtkGmshMeshWriter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::WriteData()
{
  if (!this->FileName || !this->FileName[0])
  {
    vtkErrorMacro("No file name: set FileName.");
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    return;
  }
  auto grid = vtkUnstructuredGrid::SafeDownCast(this->GetInput());
  auto contacts = vtkPolyData::SafeDownCast(this->GetExecutive()->GetInputData(1, 0));
  GroupCollector collector(grid, contacts);
  vtkDataSet* faulty = nullptr;
  const cdm::Status status = cdm::RunGuarded([&] { return collector.Run(faulty); });
  if (!status.IsOk())
  {
    vtkCoreBridge::ReportError(this, status, faulty);
    this->SetErrorCode(vtkErrorCode::UnknownError);
    return;
  }
  vtksys::ofstream file(this->FileName);
  if (!file)
  {
    vtkErrorMacro("Cannot open the file " << this->FileName << " for writing.");
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    return;
  }
  file.imbue(std::locale::classic());
  collector.Write(file);
  file.close();
  if (!file)
  {
    vtkErrorMacro("Cannot write all of the file " << this->FileName << ": is the disk full?");
    this->SetErrorCode(vtkErrorCode::OutOfDiskSpaceError);
  }
}

//--------------------------------------------------------------------------------------------------
void vtkGmshMeshWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}
