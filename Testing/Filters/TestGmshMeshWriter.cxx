// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkDelaunayMeshCriteria.h>
#include <vtkGmshMeshWriter.h>
#include <vtkTechnologyStructureSource.h>

#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>
#include <vtkTransform.h>
#include <vtkTransformFilter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

using namespace testing_filters;

namespace
{
/** Tests run beside each other: each has a file of its own. */
class GmshMeshWriter : public testing::Test
{
protected:
  const std::string FileName = std::string(CDM_OUTPUT_DIR) + "/TestGmshMeshWriter" +
    testing::UnitTest::GetInstance()->current_test_info()->name() + ".msh";
};

/**
 * A Gmsh 2.2 file, read by the rules of DEVSIM's reader: the format line, names of dimension 0 to 3
 * with positive numbers that are words and unique, positive node numbers, numbers that its scanner
 * knows, elements of known type with a positive physical number and the right number of nodes.
 */
struct GmshFile
{
  std::map<int, std::string> Names;
  std::map<int, int> Dimensions;
  std::map<int, Point> Nodes;
  struct Element
  {
    int Physical;
    std::vector<int> Nodes;
  };
  std::vector<Element> Triangles;
  std::vector<Element> Tetrahedra;

  int GetNumber(const std::string& name) const
  {
    for (const auto& [number, other] : this->Names)
    {
      if (other == name)
      {
        return number;
      }
    }
    ADD_FAILURE() << "no physical group " << name;
    return 0;
  }
  double GetVolume(int physical) const
  {
    double volume = 0.0;
    for (const Element& element : this->Tetrahedra)
    {
      if (element.Physical == physical)
      {
        double x[4][3];
        for (int i = 0; i < 4; ++i)
        {
          std::copy_n(this->Nodes.at(element.Nodes[i]).begin(), 3, x[i]);
        }
        volume += vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3]);
      }
    }
    return volume;
  }
  double GetArea(int physical) const
  {
    double area = 0.0;
    for (const Element& element : this->Triangles)
    {
      if (element.Physical == physical)
      {
        double x[3][3];
        for (int i = 0; i < 3; ++i)
        {
          std::copy_n(this->Nodes.at(element.Nodes[i]).begin(), 3, x[i]);
        }
        area += vtkTriangle::TriangleArea(x[0], x[1], x[2]);
      }
    }
    return area;
  }
};

GmshFile Read(const std::string& name)
{
  GmshFile result;
  std::ifstream file(name);
  EXPECT_TRUE(file.good()) << name;
  std::string line;
  const auto expectLine = [&](const std::string& expected)
  {
    std::getline(file, line);
    EXPECT_EQ(expected, line);
  };
  const auto readCount = [&]
  {
    std::getline(file, line);
    return std::stoi(line);
  };
  expectLine("$MeshFormat");
  expectLine("2.2 0 8");
  expectLine("$EndMeshFormat");
  expectLine("$PhysicalNames");
  const std::regex nameLine("([0-3]) ([0-9]+) \"([A-Za-z][A-Za-z_0-9]*)\"");
  std::set<std::string> words;
  for (int i = readCount(); i > 0; --i)
  {
    std::getline(file, line);
    std::smatch match;
    EXPECT_TRUE(std::regex_match(line, match, nameLine)) << line;
    const int number = std::stoi(match[2]);
    EXPECT_GT(number, 0);
    EXPECT_TRUE(words.insert(match[3]).second) << "twice: " << match[3];
    EXPECT_TRUE(result.Names.emplace(number, match[3]).second);
    result.Dimensions[number] = std::stoi(match[1]);
  }
  expectLine("$EndPhysicalNames");
  expectLine("$Nodes");
  const std::regex number("[-+]?[0-9]*\\.[0-9]+|[-+]?[0-9]+\\.[0-9]*|[-+]?[0-9]+\\.?[0-9]*[eE][-+]?"
                          "[0-9]+|-?[0-9]+");
  for (int i = readCount(); i > 0; --i)
  {
    std::getline(file, line);
    std::istringstream stream(line);
    int node = 0;
    std::string coordinates[3];
    stream >> node >> coordinates[0] >> coordinates[1] >> coordinates[2];
    EXPECT_GT(node, 0);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_TRUE(std::regex_match(coordinates[axis], number)) << line;
      result.Nodes[node][axis] = std::strtod(coordinates[axis].c_str(), nullptr);
    }
  }
  expectLine("$EndNodes");
  expectLine("$Elements");
  for (int i = readCount(); i > 0; --i)
  {
    std::getline(file, line);
    std::istringstream stream(line);
    int head[5];
    for (int& value : head)
    {
      stream >> value;
      EXPECT_GT(value, 0) << line;
    }
    EXPECT_EQ(2, head[2]) << "tags";
    const bool isTetrahedron = head[1] == 4;
    EXPECT_TRUE(isTetrahedron || head[1] == 2) << line;
    GmshFile::Element element{ head[3], {} };
    for (int node = 0; stream >> node;)
    {
      EXPECT_EQ(1u, result.Nodes.count(node)) << line;
      element.Nodes.push_back(node);
    }
    EXPECT_EQ(isTetrahedron ? 4u : 3u, element.Nodes.size()) << line;
    EXPECT_EQ(isTetrahedron ? 3 : 2, result.Dimensions[head[3]]) << line;
    (isTetrahedron ? result.Tetrahedra : result.Triangles).push_back(element);
  }
  expectLine("$EndElements");
  return result;
}

vtkSmartPointer<vtkStringArray> MakeNames(const char* name, const std::vector<std::string>& values)
{
  auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetName(name);
  for (const std::string& value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

/** True if the program is there and ends well. */
bool RunGmshCheck(const std::string& file, std::string& output)
{
  const std::string command = "gmsh -check \"" + file + "\" 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[256];
  while (pipe && std::fgets(buffer, sizeof buffer, pipe))
  {
    output += buffer;
  }
  return pipe && pclose(pipe) == 0;
}
} // namespace

TEST_F(GmshMeshWriter, DeviceWithNames)
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  device->Update();
  vtkNew<vtkPolyData> named;
  named->ShallowCopy(device->GetOutput());
  vtkNew<vtkFieldData> names;
  names->AddArray(
    MakeNames("RegionNames", { "Bulk", "gate oxide", "Gate", "1st spacer", "1st spacer" }));
  named->SetFieldData(names);
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(named);
  mesher->SetMaximumEdgeLength(0.2);
  mesher->Update();
  vtkNew<vtkGmshMeshWriter> writer;
  // Without the pipeline there are no contacts.
  writer->SetInputData(mesher->GetOutput());
  writer->SetFileName(FileName.c_str());
  ASSERT_EQ(1, writer->Write());

  const GmshFile file = Read(FileName);
  vtkUnstructuredGrid* mesh = mesher->GetOutput();
  EXPECT_EQ(static_cast<std::size_t>(mesh->GetNumberOfCells()), file.Tetrahedra.size());
  EXPECT_EQ(static_cast<std::size_t>(mesh->GetNumberOfPoints()), file.Nodes.size());
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double x[3];
    mesh->GetPoint(i, x);
    EXPECT_TRUE(std::equal(x, x + 3, file.Nodes.at(static_cast<int>(i) + 1).begin())) << i;
  }
  vtkPolyData* boundary = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  EXPECT_EQ(static_cast<std::size_t>(boundary->GetNumberOfCells()), file.Triangles.size());
  const char* expected[] = { "Bulk", "gate_oxide", "Gate", "n1st_spacer", "n1st_spacer_2" };
  for (int region = 0; region < 5; ++region)
  {
    const int group = file.GetNumber(expected[region]);
    EXPECT_EQ(3, file.Dimensions.at(group));
    EXPECT_NEAR(1.0, file.GetVolume(group) / GetVolume(mesh, region), 1e-12);
  }
  EXPECT_NEAR(
    1.0, file.GetArea(file.GetNumber("Bulk_gate_oxide")) / GetArea(boundary, 0, 1), 1e-12);
  for (const auto& [number, name] : file.Names)
  {
    EXPECT_EQ(number <= 5, file.Dimensions.at(number) == 3) << "regions by their ids: " << name;
  }
  EXPECT_EQ(1, file.GetNumber("Bulk"));
  EXPECT_EQ(5, file.GetNumber("n1st_spacer_2"));
  EXPECT_EQ(6, file.GetNumber("Bulk_gate_oxide")) << "the first interface";
  // 0.8 x 0.3 micrometres.
  EXPECT_NEAR(0.24, file.GetArea(file.GetNumber("Bulk_zmin")), 1e-12);
}

TEST_F(GmshMeshWriter, NamesOutliveTheWritersOfVtk)
{
  // What XML and the encoding stand on, and an umlaut; a name may be empty.
  const std::vector<std::string> odd = { "Si & \"Ge\" <30%>", "", "100%25", "\xc3\xbc\n'" };
  vtkNew<vtkTechnologyStructureSource> device;
  device->Update();
  device->GetOutput()->GetFieldData()->AddArray(MakeNames("RegionNames", odd));
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(device->GetOutput());
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->WriteToOutputStringOn();
  writer->Write();
  EXPECT_FALSE(Contains(writer->GetOutputString(), "\"String\"")) << "other readers refuse it";
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  vtkNew<vtkGmshMeshWriter> gmsh;
  gmsh->SetInputConnection(reader->GetOutputPort());
  gmsh->SetFileName(FileName.c_str());
  ASSERT_EQ(1, gmsh->Write());
  const GmshFile file = Read(FileName);
  for (const char* name : { "Si____Ge___30__", "region_1", "n100_25", "n____" })
  {
    EXPECT_EQ(3, file.Dimensions.at(file.GetNumber(name))) << name;
  }
  EXPECT_EQ(GetTexts(reader->GetOutput(), "Certificate").at(0), "DELAUNAY");
  std::vector<std::string> read = GetTexts(reader->GetOutput(), "RegionNames");
  EXPECT_EQ(read, odd);
}

namespace
{
/** Two boxes, of 1 and 2 cubes, with a contact for each polygon by its bounds; -1: none. */
vtkSmartPointer<vtkPolyData> MakeBoxesWithContacts(int (*getContact)(const double*))
{
  const auto boxes = MakeTwoBoxes(true);
  vtkNew<vtkIntArray> contacts;
  contacts->SetName("ContactId");
  double bounds[6];
  for (vtkIdType i = 0; i < boxes->GetNumberOfCells(); ++i)
  {
    boxes->GetCellBounds(i, bounds);
    contacts->InsertNextValue(getContact(bounds));
  }
  boxes->GetCellData()->AddArray(contacts);
  return boxes;
}

/** The boundary of a mesher with names of contacts. */
vtkSmartPointer<vtkPolyData> NameContacts(
  vtkConformingDelaunayMesher* mesher, const std::vector<std::string>& names)
{
  mesher->Update();
  auto boundary = vtkSmartPointer<vtkPolyData>::New();
  boundary->ShallowCopy(mesher->GetOutputDataObject(1));
  vtkNew<vtkFieldData> fields;
  fields->AddArray(MakeNames("ContactNames", names));
  boundary->SetFieldData(fields);
  return boundary;
}
} // namespace

// Two regions have all of a contact between them: it keeps its name. Others change neither numbers
// nor names.
TEST_F(GmshMeshWriter, ContactsKeepTheirNamesAndChangeNoOthers)
{
  const auto boxes = MakeBoxesWithContacts(
    [](const double* bounds) {
      return bounds[0] == bounds[1] && bounds[0] == 1.0 ? 1 : bounds[0] == 3.0 ? 0 : -1;
    });
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(boxes);
  mesher->SetMaximumEdgeLength(0.5);
  const auto boundary = NameContacts(mesher, { "region_3_region_7", "source-contact" });
  vtkNew<vtkGmshMeshWriter> writer;
  writer->SetInputData(mesher->GetOutput());
  writer->SetFileName(FileName.c_str());
  ASSERT_EQ(1, writer->Write());
  const GmshFile before = Read(FileName);
  writer->SetInputData(1, boundary);
  ASSERT_EQ(1, writer->Write());
  const GmshFile after = Read(FileName);

  EXPECT_NEAR(1.0, after.GetArea(after.GetNumber("source_contact")), 1e-12);
  EXPECT_NEAR(1.0, after.GetArea(after.GetNumber("region_3_region_7")), 1e-12) << "the contact";
  EXPECT_NEAR(1.0, after.GetArea(after.GetNumber("region_3_region_7_2")), 1e-12);
  EXPECT_EQ(4, before.GetNumber("region_3"));
  EXPECT_EQ(8, before.GetNumber("region_7"));
  EXPECT_EQ(9, before.GetNumber("region_3_region_7"));
  EXPECT_EQ(9, after.GetNumber("region_3_region_7_2"));
  int missing = 0;
  for (const auto& [number, name] : before.Names)
  {
    if (after.Names.count(number) == 0)
    {
      EXPECT_EQ("region_7_xmax", name) << "the contact took all of it";
      ++missing;
    }
    else if (number != 9)
    {
      EXPECT_EQ(name, after.Names.at(number));
    }
  }
  EXPECT_EQ(1, missing);
  EXPECT_EQ(before.Names.size() + 1, after.Names.size());
}

TEST_F(GmshMeshWriter, ContactsOfTheMesherAreFound)
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputConnection(device->GetOutputPort());
  mesher->Update();
  vtkNew<vtkGmshMeshWriter> writer;
  writer->SetFileName(FileName.c_str());
  writer->SetInputConnection(0, mesher->GetOutputPort(0));
  writer->SetInputConnection(1, mesher->GetOutputPort(1));
  ASSERT_EQ(1, writer->Write());
  const GmshFile given = Read(FileName);
  EXPECT_GT(given.GetNumber("SourceContact"), 0);
  writer->RemoveAllInputConnections(1);
  ASSERT_EQ(1, writer->Write());
  EXPECT_EQ(given.Names, Read(FileName).Names);

  // Also behind a filter that hands the mesh on, but not behind one that changes it.
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputConnection(mesher->GetOutputPort());
  writer->SetInputConnection(criteria->GetOutputPort());
  ASSERT_EQ(1, writer->Write());
  EXPECT_EQ(given.Names, Read(FileName).Names);
  vtkNew<vtkTransform> transform;
  transform->Scale(2.0, 2.0, 2.0);
  vtkNew<vtkTransformFilter> scaled;
  scaled->SetTransform(transform);
  scaled->SetInputConnection(mesher->GetOutputPort());
  writer->SetInputConnection(scaled->GetOutputPort());
  ASSERT_EQ(1, writer->Write());
  EXPECT_EQ(Read(FileName).Tetrahedra.size(), given.Tetrahedra.size());
  for (const auto& [number, name] : Read(FileName).Names)
  {
    EXPECT_FALSE(Contains(name, "Contact")) << name;
  }
}

TEST_F(GmshMeshWriter, ContactsOfSeveralRegions)
{
  // The ends of the long box, and its bottom, which belongs to both regions.
  const auto boxes = MakeBoxesWithContacts(
    [](const double* bounds) {
      return bounds[1] == 0.0 ? 0 : bounds[0] == 3.0 ? 2 : bounds[5] == 0.0 ? 1 : -1;
    });
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetInputData(boxes);
  mesher->SetMaximumEdgeLength(0.5);
  const auto boundary = NameContacts(mesher, { "source", "bottom", "drain" });
  vtkNew<vtkGmshMeshWriter> writer;
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->SetInputData(1, boundary);
  writer->SetFileName(FileName.c_str());
  ASSERT_EQ(1, writer->Write());
  const GmshFile file = Read(FileName);
  EXPECT_NEAR(1.0, file.GetArea(file.GetNumber("source")), 1e-12);
  EXPECT_NEAR(1.0, file.GetArea(file.GetNumber("drain")), 1e-12);
  EXPECT_NEAR(1.0, file.GetArea(file.GetNumber("bottom_region_3")), 1e-12);
  EXPECT_NEAR(2.0, file.GetArea(file.GetNumber("bottom_region_7")), 1e-12);
  EXPECT_NEAR(1.0, file.GetArea(file.GetNumber("region_3_region_7")), 1e-12);
  EXPECT_NEAR(2.0, file.GetArea(file.GetNumber("region_7_zmax")), 1e-12);
  for (const auto& [number, name] : file.Names)
  {
    EXPECT_NE("region_3_xmin", name) << "the contact took all of it";
  }
  // Every facet is in one group: the surface of the long box and the interface.
  double area = 0.0;
  for (const auto& [number, name] : file.Names)
  {
    area += file.GetArea(number);
  }
  EXPECT_NEAR(14.0 + 1.0, area, 1e-12);

  // A contact that is no facet of the mesh.
  const auto square = MakeSquare();
  vtkNew<vtkIntArray> one;
  one->SetName("ContactId");
  one->InsertNextValue(0);
  square->GetCellData()->AddArray(one);
  writer->SetInputData(1, square);
  std::remove(FileName.c_str());
  vtkNew<EventRecorder> recorder;
  recorder->Watch(writer);
  writer->Write();
  EXPECT_TRUE(Contains(recorder->Errors, "no facets of the mesh")) << recorder->Errors;
  EXPECT_TRUE(Contains(recorder->Errors, "Cells: 0")) << recorder->Errors;
  EXPECT_NE(vtkErrorCode::NoError, static_cast<int>(writer->GetErrorCode()));
  EXPECT_FALSE(std::ifstream(FileName).good()) << "no file";
}

TEST_F(GmshMeshWriter, GmshAcceptsIt)
{
  if (std::system("gmsh -version > /dev/null 2>&1") != 0)
  {
    GTEST_SKIP() << "Gmsh is not installed.";
  }
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToViaPlug();
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputConnection(device->GetOutputPort());
  vtkNew<vtkGmshMeshWriter> writer;
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->SetFileName(FileName.c_str());
  ASSERT_EQ(1, writer->Write());
  std::string output;
  EXPECT_TRUE(RunGmshCheck(FileName, output)) << output;
  EXPECT_FALSE(Contains(output, "Error")) << output;
  EXPECT_FALSE(Contains(output, "Warning")) << output;
  const GmshFile file = Read(FileName);
  EXPECT_TRUE(Contains(output, std::to_string(file.Nodes.size()) + " nodes")) << output;
}

TEST_F(GmshMeshWriter, BadInputAndFiles)
{
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputData(MakeCube());
  vtkNew<vtkGmshMeshWriter> writer;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(writer);
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->Write();
  EXPECT_TRUE(Contains(recorder->Errors, "FileName")) << recorder->Errors;
  writer->SetFileName("/nowhere/at/all.msh");
  writer->Write();
  EXPECT_TRUE(Contains(recorder->Errors, "/nowhere/at/all.msh")) << recorder->Errors;

  vtkNew<vtkUnstructuredGrid> triangle;
  triangle->SetPoints(mesher->GetOutput()->GetPoints());
  const vtkIdType ids[3] = { 0, 1, 2 };
  triangle->AllocateEstimate(1, 3);
  triangle->InsertNextCell(VTK_TRIANGLE, 3, ids);
  writer->SetInputData(triangle);
  writer->SetFileName(FileName.c_str());
  writer->Write();
  EXPECT_TRUE(Contains(recorder->Errors, "not linear tetrahedra")) << recorder->Errors;
}
