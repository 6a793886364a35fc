// SPDX-License-Identifier: BSD-3-Clause
#include "Gmsh/DevsimScript.h"

#include "Gmsh/DevsimDevice.h"
#include "Gmsh/GmshFile.h"

#include <vtkBase64Utilities.h>
#include <vtkByteSwap.h>
#include <vtkDataArray.h>

#include <algorithm>
#include <cstdint>

namespace vtkGmsh
{
namespace
{
/** In a string of Python. */
std::string Quote(const std::string& text)
{
  std::string quoted = "\"";
  for (const char character : text)
  {
    if (character == '"' || character == '\\')
    {
      quoted += '\\';
    }
    quoted += character;
  }
  return quoted + "\"";
}

/** Numbers of four or eight bytes as lines of base64, the lowest byte first. */
template <typename Number>
std::string Encode(std::vector<Number> numbers)
{
  if (sizeof(Number) == 8)
  {
    vtkByteSwap::Swap8LERange(numbers.data(), numbers.size());
  }
  else
  {
    vtkByteSwap::Swap4LERange(numbers.data(), numbers.size());
  }
  const auto bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  const std::size_t size = numbers.size() * sizeof(Number);
  constexpr std::size_t LineSize = 72;
  std::string text = "\"\"\"";
  std::vector<unsigned char> line(2 * LineSize);
  for (std::size_t begin = 0; begin < size; begin += LineSize)
  {
    const std::size_t length = vtkBase64Utilities::Encode(
      bytes + begin, static_cast<unsigned long>(std::min(LineSize, size - begin)), line.data(), 0);
    text += "\n" + std::string(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(length));
  }
  return text + "\"\"\"";
}

/** The boxes and couplings of a region. */
struct RegionData
{
  std::vector<std::int32_t> Points;
  std::vector<double> Volumes;
  std::vector<std::int32_t> Edges;
  std::vector<double> Areas;
};

RegionData Collect(const cdm::ControlVolumes& volumes, cdm::Id region,
  const std::vector<std::size_t>& nodes, double scale)
{
  RegionData data;
  const auto getIndex = [&nodes](cdm::Id point)
  { return static_cast<std::int32_t>(nodes[point] - 1); };
  for (const cdm::ControlBox& box : volumes.Boxes)
  {
    if (box.Region == region)
    {
      data.Points.push_back(getIndex(box.Point));
      data.Volumes.push_back(box.Volume * (scale * scale * scale));
    }
  }
  for (const cdm::EdgeCoupling& coupling : volumes.Couplings)
  {
    if (coupling.Region == region)
    {
      data.Edges.push_back(getIndex(coupling.Points[0]));
      data.Edges.push_back(getIndex(coupling.Points[1]));
      data.Areas.push_back(coupling.Area * (scale * scale));
    }
  }
  return data;
}

void WritePointArrays(
  const DevsimScriptOptions& options, const std::vector<std::size_t>& nodes, std::ostream& file)
{
  file << "\n#: By name: one number for each point.\nPOINT_VALUES = {\n";
  for (vtkDataArray* array : options.PointArrays)
  {
    const int components = array->GetNumberOfComponents();
    for (int component = 0; component < components; ++component)
    {
      std::vector<double> values;
      for (std::size_t point = 0; point < nodes.size(); ++point)
      {
        if (nodes[point] != 0)
        {
          values.push_back(array->GetComponent(static_cast<vtkIdType>(point), component));
        }
      }
      const std::string suffix = components == 1 ? "" : "_" + std::to_string(component);
      file << "    " << Quote(MakeWord(array->GetName()) + suffix) << ": " << Encode(values)
           << ",\n";
    }
  }
  file << "}\n";
}

/** What follows the data. */
constexpr const char* CreateDeviceText = R"python(

def create_device(name=DEVICE, regions=None, contacts=None, materials=None, mesh_file=None):
    """Makes the device in DEVSIM.

    Args:
        name: what DEVSIM will call it.
        regions: those to be made, the first of which counts for values at interfaces; None: all.
        contacts: by name the physical group, or a pair of it and a region; None: the contacts of
            the file.
        materials: by region; without one the region's name is that of its material.
        mesh_file: None: the one beside this script.

    Returns:
        A Device.
    """
    if mesh_file is None:
        mesh_file = os.path.join(os.path.dirname(os.path.abspath(__file__)), MESH_FILE)
    control_volumes = {
        region: decode_control_volumes(*texts) for region, texts in CONTROL_VOLUMES.items()
    }
    device = build_device(
        name,
        {"file": mesh_file},
        NUMBER_OF_POINTS,
        control_volumes,
        SURFACES,
        regions=regions,
        contacts=contacts,
        materials=materials,
    )
    for model, text in POINT_VALUES.items():
        device.set_node_values(model, decode("d", text))
    return device


if __name__ == "__main__":
    create_device()
)python";
} // namespace

void WriteDevsimScript(const GroupedMesh& mesh, const cdm::ControlVolumes& volumes,
  const DevsimScriptOptions& options, std::ostream& file)
{
  const std::vector<std::size_t> nodes = NumberNodes(mesh.Mesh);
  file << DevsimDeviceText
       << "\n\n# The device: written by vtkGmshMeshWriter together with the file.\n"
          "import os  # noqa: E402\n\n#: Lengths in the file are those of the model times "
       << options.Scale << ".\nMESH_FILE = " << Quote(options.MeshFile)
       << "\nDEVICE = " << Quote(options.Device) << "\nNUMBER_OF_POINTS = "
       << (nodes.empty() ? 0 : *std::max_element(nodes.begin(), nodes.end()))
       << "\n\n#: By physical group: what it is, and the regions that have all of it.\n"
          "SURFACES = {\n";
  constexpr const char* Kinds[] = { "region", "interface", "side", "contact" };
  for (const PhysicalGroup& group : mesh.Groups)
  {
    if (group.Kind != PhysicalGroup::Region)
    {
      file << "    " << Quote(group.Name) << ": (" << Quote(Kinds[group.Kind]) << ", [";
      for (const cdm::Id region : group.Regions)
      {
        file << (region == group.Regions.front() ? "" : ", ") << Quote(mesh.GetRegion(region).Name);
      }
      file << "]),\n";
    }
  }
  file << "}\n\n#: By region: points, their box volumes; edges, their coupling areas.\n"
          "CONTROL_VOLUMES = {\n";
  for (const PhysicalGroup& group : mesh.Groups)
  {
    if (group.Kind == PhysicalGroup::Region)
    {
      const RegionData data = Collect(volumes, group.First, nodes, options.Scale);
      file << "    " << Quote(group.Name) << ": (" << Encode(data.Points) << ", "
           << Encode(data.Volumes) << ", " << Encode(data.Edges) << ", " << Encode(data.Areas)
           << "),\n";
    }
  }
  file << "}\n";
  WritePointArrays(options, nodes, file);
  file << CreateDeviceText;
}
} // namespace vtkGmsh
