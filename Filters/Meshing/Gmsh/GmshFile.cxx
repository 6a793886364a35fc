// SPDX-License-Identifier: BSD-3-Clause
#include "Gmsh/GmshFile.h"

#include "vtkConformingDelaunayCompatibility.h"

#include "Core/Geometry/Box.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace vtkGmsh
{
namespace
{
using vtkConformingDelaunayCompatibility::ToText;

/** Codes of the formats. */
constexpr int TriangleType = 2;
constexpr int TetrahedronType = 4;

class Writer
{
public:
  Writer(const GroupedMesh& mesh, const GmshFileOptions& options, std::ostream& file)
    : Groups(mesh.Groups), Mesh(mesh.Mesh), Options(options), File(file),
      Nodes(NumberNodes(mesh.Mesh))
  {
    this->NumberOfNodes =
      this->Nodes.empty() ? 0 : *std::max_element(this->Nodes.begin(), this->Nodes.end());
    for (const PhysicalGroup& group : this->Groups)
    {
      this->NumberOfFacets += group.Facets.size();
    }
  }

  void Run();

private:
  std::string GetPosition(std::size_t point) const
  {
    const cdm::Vec3& p = this->Mesh.Points[point];
    const double scale = this->Options.Scale;
    return ToText(scale * p.X) + " " + ToText(scale * p.Y) + " " + ToText(scale * p.Z);
  }
  template <std::size_t Size>
  std::string GetNodes(const std::array<cdm::Id, Size>& points) const
  {
    std::string text;
    for (const cdm::Id point : points)
    {
      text += " " + std::to_string(this->Nodes[point]);
    }
    return text;
  }
  std::size_t GetRegionIndex(std::size_t tetrahedron) const
  {
    // Regions come first, ascending.
    const auto found = std::lower_bound(this->Groups.begin(), this->Groups.end(),
      this->Mesh.Regions[tetrahedron] + 1,
      [](const PhysicalGroup& group, int number) { return group.Number < number; });
    return found - this->Groups.begin();
  }
  /** Points and tetrahedra in the order of the file, by the group that has them in 4.1. */
  std::vector<std::vector<std::size_t>> GetPointBlocks() const;
  std::vector<std::vector<std::size_t>> GetTetrahedronBlocks() const;
  void WriteNames();
  void WriteNodes2();
  void WriteElements2();
  void WriteEntities4();
  void WriteNodes4();
  void WriteElements4();
  /** A node or element, and the point or cell that it has the data of. */
  struct Item
  {
    std::size_t Number;
    std::size_t Tuple;
  };
  void WriteData(const char* section, vtkDataArray* array, const std::vector<Item>& items);

  const std::vector<PhysicalGroup>& Groups;
  const cdm::TetMesh& Mesh;
  const GmshFileOptions& Options;
  std::ostream& File;
  std::vector<std::size_t> Nodes;
  std::size_t NumberOfNodes = 0;
  std::size_t NumberOfFacets = 0;
};

void Writer::Run()
{
  this->File << "$MeshFormat\n"
             << (this->Options.IsVersion4 ? "4.1" : "2.2") << " 0 8\n$EndMeshFormat\n";
  this->WriteNames();
  if (this->Options.IsVersion4)
  {
    this->WriteEntities4();
    this->WriteNodes4();
    this->WriteElements4();
  }
  else
  {
    this->WriteNodes2();
    this->WriteElements2();
  }
  // In the order of the file: some readers do not look at the numbers.
  std::vector<Item> nodes;
  for (const std::vector<std::size_t>& block : this->GetPointBlocks())
  {
    for (const std::size_t point : block)
    {
      nodes.push_back({ this->Nodes[point], point });
    }
  }
  for (vtkDataArray* array : this->Options.PointArrays)
  {
    this->WriteData("NodeData", array, nodes);
  }
  std::vector<Item> elements;
  for (const PhysicalGroup& group : this->Groups)
  {
    for (const GroupFacet& facet : group.Facets)
    {
      elements.push_back({ elements.size() + 1, static_cast<std::size_t>(facet.Tetrahedron) });
    }
  }
  for (const std::vector<std::size_t>& block : this->GetTetrahedronBlocks())
  {
    for (const std::size_t tetrahedron : block)
    {
      elements.push_back({ this->NumberOfFacets + 1 + tetrahedron, tetrahedron });
    }
  }
  for (vtkDataArray* array : this->Options.CellArrays)
  {
    this->WriteData("ElementData", array, elements);
  }
}

std::vector<std::vector<std::size_t>> Writer::GetPointBlocks() const
{
  std::vector<std::size_t> owners(this->Nodes.size(), this->Groups.size());
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    const std::size_t region = this->Options.IsVersion4 ? this->GetRegionIndex(i) : 0;
    for (const cdm::Id point : this->Mesh.Tetrahedra[i])
    {
      owners[point] = std::min(owners[point], region);
    }
  }
  std::vector<std::vector<std::size_t>> blocks(this->Groups.size());
  for (std::size_t i = 0; i < owners.size(); ++i)
  {
    if (owners[i] < blocks.size())
    {
      blocks[owners[i]].push_back(i);
    }
  }
  return blocks;
}

std::vector<std::vector<std::size_t>> Writer::GetTetrahedronBlocks() const
{
  std::vector<std::vector<std::size_t>> blocks(this->Groups.size());
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    blocks[this->Options.IsVersion4 ? this->GetRegionIndex(i) : 0].push_back(i);
  }
  return blocks;
}

void Writer::WriteNames()
{
  this->File << "$PhysicalNames\n" << this->Groups.size() << "\n";
  for (const PhysicalGroup& group : this->Groups)
  {
    this->File << group.GetDimension() << " " << group.Number << " \"" << group.Name << "\"\n";
  }
  this->File << "$EndPhysicalNames\n";
}

void Writer::WriteNodes2()
{
  this->File << "$Nodes\n" << this->NumberOfNodes << "\n";
  for (std::size_t i = 0; i < this->Nodes.size(); ++i)
  {
    if (this->Nodes[i] != 0)
    {
      this->File << this->Nodes[i] << " " << this->GetPosition(i) << "\n";
    }
  }
  this->File << "$EndNodes\n";
}

void Writer::WriteElements2()
{
  this->File << "$Elements\n" << this->NumberOfFacets + this->Mesh.Tetrahedra.size() << "\n";
  std::size_t element = 0;
  const auto write = [&](int type, int number, const std::string& nodes)
  { this->File << ++element << " " << type << " 2 " << number << " " << number << nodes << "\n"; };
  for (const PhysicalGroup& group : this->Groups)
  {
    for (const GroupFacet& facet : group.Facets)
    {
      write(TriangleType, group.Number, this->GetNodes(facet.Points));
    }
  }
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    write(TetrahedronType, this->Mesh.Regions[i] + 1, this->GetNodes(this->Mesh.Tetrahedra[i]));
  }
  this->File << "$EndElements\n";
}

void Writer::WriteEntities4()
{
  std::vector<cdm::Box> boxes(this->Groups.size());
  for (std::size_t i = 0; i < this->Groups.size(); ++i)
  {
    for (const GroupFacet& facet : this->Groups[i].Facets)
    {
      for (const cdm::Id point : facet.Points)
      {
        boxes[i].Add(this->Mesh.Points[point]);
      }
    }
  }
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    for (const cdm::Id point : this->Mesh.Tetrahedra[i])
    {
      boxes[this->GetRegionIndex(i)].Add(this->Mesh.Points[point]);
    }
  }
  const std::size_t surfaces = std::count_if(this->Groups.begin(), this->Groups.end(),
    [](const PhysicalGroup& group) { return group.GetDimension() == 2; });
  this->File << "$Entities\n0 0 " << surfaces << " " << this->Groups.size() - surfaces << "\n";
  for (const int dimension : { 2, 3 })
  {
    for (std::size_t i = 0; i < this->Groups.size(); ++i)
    {
      if (this->Groups[i].GetDimension() == dimension)
      {
        const int number = this->Groups[i].Number;
        this->File << number;
        for (const cdm::Vec3& corner : { boxes[i].Low, boxes[i].High })
        {
          for (int axis = 0; axis < 3; ++axis)
          {
            this->File << " " << ToText(this->Options.Scale * corner[axis]);
          }
        }
        // One physical group; what bounds the entity is not said.
        this->File << " 1 " << number << " 0\n";
      }
    }
  }
  this->File << "$EndEntities\n";
}

void Writer::WriteNodes4()
{
  const std::vector<std::vector<std::size_t>> points = this->GetPointBlocks();
  const std::size_t blocks =
    std::count_if(points.begin(), points.end(), [](const auto& block) { return !block.empty(); });
  this->File << "$Nodes\n"
             << blocks << " " << this->NumberOfNodes << " 1 " << this->NumberOfNodes << "\n";
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (points[i].empty())
    {
      continue;
    }
    this->File << "3 " << this->Groups[i].Number << " 0 " << points[i].size() << "\n";
    for (const std::size_t point : points[i])
    {
      this->File << this->Nodes[point] << "\n";
    }
    for (const std::size_t point : points[i])
    {
      this->File << this->GetPosition(point) << "\n";
    }
  }
  this->File << "$EndNodes\n";
}

void Writer::WriteElements4()
{
  const std::size_t count = this->NumberOfFacets + this->Mesh.Tetrahedra.size();
  this->File << "$Elements\n" << this->Groups.size() << " " << count << " 1 " << count << "\n";
  const std::vector<std::vector<std::size_t>> tetrahedra = this->GetTetrahedronBlocks();
  std::size_t element = 0;
  const auto writeHead = [this](const PhysicalGroup& group, int type, std::size_t size)
  {
    this->File << group.GetDimension() << " " << group.Number << " " << type << " " << size << "\n";
  };
  for (const PhysicalGroup& group : this->Groups)
  {
    if (group.GetDimension() == 2)
    {
      writeHead(group, TriangleType, group.Facets.size());
    }
    for (const GroupFacet& facet : group.Facets)
    {
      this->File << ++element << this->GetNodes(facet.Points) << "\n";
    }
  }
  for (std::size_t i = 0; i < this->Groups.size(); ++i)
  {
    if (this->Groups[i].GetDimension() == 3)
    {
      writeHead(this->Groups[i], TetrahedronType, tetrahedra[i].size());
    }
    for (const std::size_t tetrahedron : tetrahedra[i])
    {
      this->File << this->NumberOfFacets + 1 + tetrahedron
                 << this->GetNodes(this->Mesh.Tetrahedra[tetrahedron]) << "\n";
    }
  }
  this->File << "$EndElements\n";
}

void Writer::WriteData(const char* section, vtkDataArray* array, const std::vector<Item>& items)
{
  const int components = array->GetNumberOfComponents();
  // A scalar, a vector or a tensor, with zeros at the end.
  const int width = components == 1 ? 1 : components <= 3 ? 3 : 9;
  std::string name = array->GetName();
  std::replace(name.begin(), name.end(), '"', '_');
  this->File << "$" << section << "\n1\n\"" << name << "\"\n1\n0\n3\n0\n"
             << width << "\n"
             << items.size() << "\n";
  for (const Item& item : items)
  {
    this->File << item.Number;
    for (int j = 0; j < width; ++j)
    {
      const auto tuple = static_cast<vtkIdType>(item.Tuple);
      this->File << " " << (j < components ? ToText(array->GetComponent(tuple, j)) : "0");
    }
    this->File << "\n";
  }
  this->File << "$End" << section << "\n";
}
} // namespace

std::vector<std::size_t> NumberNodes(const cdm::TetMesh& mesh)
{
  std::vector<std::size_t> nodes(mesh.Points.size(), 0);
  for (const cdm::TetrahedronIds& ids : mesh.Tetrahedra)
  {
    for (const cdm::Id point : ids)
    {
      nodes[point] = 1;
    }
  }
  std::size_t count = 0;
  for (std::size_t& node : nodes)
  {
    node = node == 0 ? 0 : ++count;
  }
  return nodes;
}

void WriteGmshFile(const GroupedMesh& mesh, const GmshFileOptions& options, std::ostream& file)
{
  Writer(mesh, options, file).Run();
}
} // namespace vtkGmsh
