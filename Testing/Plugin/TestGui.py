# SPDX-License-Identifier: BSD-3-Clause
"""The real ParaView: loads the plugin, makes a device, meshes it by the menus, takes a picture.

Starts ParaView with the command of the README, and plays the events of Gui.xml; looks at the
picture, at the states that it saves after a change was undone and redone, at the colors and names of
the regions there, and at the picture of Plugin/Examples/mos_transistor.pvsm.
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
print("gui: ok")
sys.exit(0)
