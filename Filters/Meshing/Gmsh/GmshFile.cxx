// SPDX-License-Identifier: BSD-3-Clause
#include "Gmsh/GmshFile.h"

#include "vtkConformingDelaunayCompatibility.h"

#include "Core/Geometry/Box.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <array>
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
  const PhysicalGroup& GetRegion(std::size_t tetrahedron) const
  {
    // Few groups, regions first and ascending.
    const auto found = std::lower_bound(this->Groups.begin(), this->Groups.end(),
      this->Mesh.Regions[tetrahedron] + 1,
      [](const PhysicalGroup& group, int number) { return group.Number < number; });
    return *found;
  }
  void WriteNames();
  void WriteNodes2();
  void WriteElements2();
  void WriteEntities4();
  void WriteNodes4();
  void WriteElements4();
  void WriteData(const char* section, vtkDataArray* array, std::size_t count, std::size_t first,
    const std::vector<std::size_t>* numbers);

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
  for (vtkDataArray* array : this->Options.PointArrays)
  {
    this->WriteData("NodeData", array, this->NumberOfNodes, 0, &this->Nodes);
  }
  for (vtkDataArray* array : this->Options.CellArrays)
  {
    this->WriteData(
      "ElementData", array, this->Mesh.Tetrahedra.size(), this->NumberOfFacets + 1, nullptr);
  }
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
    for (const cdm::TriangleIds& points : group.Facets)
    {
      write(TriangleType, group.Number, this->GetNodes(points));
    }
  }
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    write(TetrahedronType, this->GetRegion(i).Number, this->GetNodes(this->Mesh.Tetrahedra[i]));
  }
  this->File << "$EndElements\n";
}

void Writer::WriteEntities4()
{
  std::vector<cdm::Box> boxes(this->Groups.size());
  for (std::size_t i = 0; i < this->Groups.size(); ++i)
  {
    for (const cdm::TriangleIds& points : this->Groups[i].Facets)
    {
      for (const cdm::Id point : points)
      {
        boxes[i].Add(this->Mesh.Points[point]);
      }
    }
  }
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    for (const cdm::Id point : this->Mesh.Tetrahedra[i])
    {
      boxes[&this->GetRegion(i) - this->Groups.data()].Add(this->Mesh.Points[point]);
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
  std::vector<const PhysicalGroup*> owners(this->Nodes.size(), nullptr);
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    const PhysicalGroup& region = this->GetRegion(i);
    for (const cdm::Id point : this->Mesh.Tetrahedra[i])
    {
      const PhysicalGroup*& owner = owners[point];
      owner = owner && owner->Number < region.Number ? owner : &region;
    }
  }
  std::vector<std::vector<std::size_t>> points(this->Groups.size());
  for (std::size_t i = 0; i < owners.size(); ++i)
  {
    if (owners[i])
    {
      points[owners[i] - this->Groups.data()].push_back(i);
    }
  }
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
  std::vector<std::vector<std::size_t>> tetrahedra(this->Groups.size());
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    tetrahedra[&this->GetRegion(i) - this->Groups.data()].push_back(i);
  }
  std::size_t element = 0;
  for (std::size_t i = 0; i < this->Groups.size(); ++i)
  {
    const PhysicalGroup& group = this->Groups[i];
    const bool isRegion = group.GetDimension() == 3;
    this->File << group.GetDimension() << " " << group.Number << " "
               << (isRegion ? TetrahedronType : TriangleType) << " "
               << (isRegion ? tetrahedra[i].size() : group.Facets.size()) << "\n";
    for (const std::size_t tetrahedron : tetrahedra[i])
    {
      this->File << this->NumberOfFacets + 1 + tetrahedron
                 << this->GetNodes(this->Mesh.Tetrahedra[tetrahedron]) << "\n";
    }
    for (const cdm::TriangleIds& points : group.Facets)
    {
      this->File << ++element << this->GetNodes(points) << "\n";
    }
  }
  this->File << "$EndElements\n";
}

void Writer::WriteData(const char* section, vtkDataArray* array, std::size_t count,
  std::size_t first, const std::vector<std::size_t>* numbers)
{
  const int components = array->GetNumberOfComponents();
  // A scalar, a vector or a tensor, with zeros at the end.
  const int width = components == 1 ? 1 : components <= 3 ? 3 : 9;
  std::string name = array->GetName();
  std::replace(name.begin(), name.end(), '"', '_');
  this->File << "$" << section << "\n1\n\"" << name << "\"\n1\n0\n3\n0\n"
             << width << "\n"
             << count << "\n";
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    const std::size_t number = numbers ? (*numbers)[i] : first + i;
    if (number == 0)
    {
      continue;
    }
    this->File << number;
    for (int j = 0; j < width; ++j)
    {
      this->File << " " << (j < components ? ToText(array->GetComponent(i, j)) : "0");
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
