# SPDX-License-Identifier: BSD-3-Clause
"""The real ParaView: loads the plugin, makes a device, meshes it by the menus, takes a picture.

Starts ParaView with the command of the README, and plays the events of Gui.xml; looks at the
picture, at the states that it saves after a change was undone and redone, at the colors and names of
the regions there, and at the picture of Plugin/Examples/mos_transistor.pvsm. Plays those of Layers.xml,
and looks for the layers in the mesh that is saved. Plays those of Repair.xml with a surface that
intersects itself, and looks at what is shown while there is no mesh, and when there is one.
"""

import ast
import os
import re
import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import GuiTesting
import ImageComparison
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


NAMES = ["Bulk", "GateOxide", "Gate", "LeftSpacer", "RightSpacer"]


def GetValues(path, kind, options):
    """The values of some options of the proxies of a kind, as a state has them."""
    for proxy in ElementTree.parse(path).getroot().iter("Proxy"):
        if proxy.get("type") == kind:
            values = {option.get("name"): [element.get("value") for element in option.iter("Element")]
                      for option in proxy.iter("Property")}
            yield [values[name] for name in options]


def GetOptions(path):
    """The options of the mesher that Gui.xml changes."""
    ((steiner, volume),) = GetValues(path, "ConformingDelaunayMesher",
                                     ("AddSteinerPoints", "MaximumVolume"))
    return [float(steiner[0]), float(volume[0])]


def CheckLegend(path):
    """Regions are categories with their names, and have the colors of the macro region_cut."""
    entries = [text for i, name in enumerate(NAMES) for text in (str(i), name)]
    (colors,) = [[float(part) for part in colors]
                 for isIndexed, annotations, colors in GetValues(
                     path, "PVLookupTable", ("IndexedLookup", "Annotations", "IndexedColors"))
                 if isIndexed == ["1"] and annotations == entries]
    macro = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Macros", "region_cut.py")
    with open(macro, encoding="utf-8") as file:
        palette = re.search(r"^COLORS = (\(.*?\)\))$", file.read(), re.MULTILINE | re.DOTALL)
    expected = [part for color in ast.literal_eval(palette.group(1)) for part in color]
    assert colors == expected, (colors, expected)


# Two tetrahedra, one of which sticks in the other.
CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
SIDES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


def WriteCrossed(path):
    with open(path, "w", encoding="ascii") as file:
        file.write("solid crossed\n")
        for shift in (0.0, 0.3):
            for side in SIDES:
                file.write("facet normal 0 0 0\nouter loop\n")
                for x, y, z in (CORNERS[corner] for corner in side):
                    file.write("vertex %g %g %g\n" % (x + shift, y, z))
                file.write("endloop\nendfacet\n")
        file.write("endsolid crossed\n")


def GetShown(path):
    """What is visible in a state: the outputs of the mesher with the arrays that color them, and the
    legends."""
    (mesher,) = [proxy.get("id") for proxy in ElementTree.parse(path).getroot().iter("Proxy")
                 if proxy.get("type") == "ConformingDelaunayMesher"]
    outputs = {}
    legends = set()
    for proxy in ElementTree.parse(path).getroot().iter("Proxy"):
        options = {option.get("name"): option for option in proxy.iter("Property")}
        values = {name: [element.get("value") for element in option.iter("Element")]
                  for name, option in options.items()}
        if values.get("Visibility") != ["1"]:
            continue
        if "ScalarBar" in proxy.get("type"):
            legends.update(values["Title"])
        elif "ColorArrayName" in options:
            given = options["Input"].find("Proxy")
            if given.get("value") == mesher:
                outputs[int(given.get("output_port"))] = values["ColorArrayName"][-1]
    return outputs, legends


def GetBlueness(path):
    """How much of the middle is blue, as the mesh of region 0 is, and how much rather yellow."""
    pixels = ImageComparison.ReadPixels(path)
    height, width, _ = pixels.shape
    middle = pixels[height // 4: 3 * height // 4, width // 4: 3 * width // 4]
    difference = middle[:, :, 2] - middle[:, :, 0] - (pixels[-1, -1, 2] - pixels[-1, -1, 0])
    return (difference > 20).mean(), (difference < -40).mean()


def CheckRepair(folder):
    """Problems are where there is no mesh, and a mesh after them looks as any."""
    WriteCrossed(os.path.join(folder, "crossed.stl"))
    GuiTesting.Run(folder, "Repair.xml", failures=("intersects itself", "returned failure"))
    for name, hasMesh in (("failed", False), ("repaired", True), ("broken", False), ("mended", True)):
        outputs, legends = GetShown(os.path.join(folder, name + ".pvsm"))
        blue, yellow = GetBlueness(os.path.join(folder, name + ".png"))
        print("%s: outputs %s, legends %s, %.0f %% mesh, %.0f %% problems" % (
            name, outputs, sorted(legends), 100 * blue, 100 * yellow))
        assert outputs.get(2) == (None if hasMesh else "ProblemKind"), outputs
        # One legend, that of what is visible.
        assert legends == {"RegionId" if hasMesh else "ProblemKind"}, legends
        assert (blue > 0.2) == hasMesh and (yellow > 0.2) != hasMesh
        if hasMesh:
            assert outputs == {0: "RegionId"}, outputs
    shutil.copy(os.path.join(folder, "broken.png"),
                os.path.join(os.environ["CDM_OUTPUT_DIR"], "GuiBroken.png"))
    shutil.copy(os.path.join(folder, "mended.png"),
                os.path.join(os.environ["CDM_OUTPUT_DIR"], "GuiMended.png"))


def CheckLayers(folder):
    """Two layers of points in the bulk below the gate oxide, whose table has names."""
    GuiTesting.Run(folder, "Layers.xml")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(folder, "layers.vtu"))
    reader.Update()
    heights = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())[:, 2]
    for depth in (0.01, 0.03):
        found = (abs(heights + depth) < 1e-12).sum()
        print("%d points of the layer at %g" % (found, depth))
        assert found > 100, (depth, found)


with tempfile.TemporaryDirectory() as folder:
    shutil.copy(os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples",
                             "mos_transistor.pvsm"), folder)
    GuiTesting.Run(folder, "Gui.xml")
    picture = os.path.join(folder, "Gui.png")
    GuiTesting.CheckPicture(picture)
    difference = ImageComparison.FindDifference(
        os.path.join(folder, "State.png"),
        ImageComparison.GetBaseline("RegionCut.png"))
    assert difference is None, difference
    for name, expected in (("undone", [-1.0, 0.0]), ("redone", [1.0, 0.0005])):
        found = GetOptions(os.path.join(folder, name + ".pvsm"))
        assert found == expected, (name, found)
    if "CDM_HAS_CLIENT_PART" in os.environ:
        CheckLegend(os.path.join(folder, "redone.pvsm"))
    shutil.copy(picture, os.path.join(os.environ["CDM_OUTPUT_DIR"], "Gui.png"))
with tempfile.TemporaryDirectory() as folder:
    CheckLayers(folder)
if "CDM_HAS_CLIENT_PART" in os.environ:
    with tempfile.TemporaryDirectory() as folder:
        CheckRepair(folder)
print("gui: ok")
sys.exit(0)
