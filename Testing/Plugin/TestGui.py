# SPDX-License-Identifier: BSD-3-Clause
"""The real ParaView: loads the plugin, makes a device, meshes it by the menus, takes a picture.

Starts ParaView with the command of the README, and plays the events of Gui.xml; looks at the
picture, at the states that it saves after a change, its undoing and its redoing, and at the
picture of Plugin/Examples/mos_transistor.pvsm.
"""

import os
import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import GuiTesting
import ImageComparison


def GetOptions(path):
    """The options of the mesher that Gui.xml changes, as a state has them."""
    (mesher,) = [proxy for proxy in ElementTree.parse(path).getroot().iter("Proxy")
                 if proxy.get("type") == "ConformingDelaunayMesher"]
    values = {option.get("name"): [element.get("value") for element in option.iter("Element")]
              for option in mesher.iter("Property")}
    return [float(values[name][0]) for name in ("AddSteinerPoints", "MaximumVolume")]


with tempfile.TemporaryDirectory() as folder:
    shutil.copy(os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples",
                             "mos_transistor.pvsm"), folder)
    GuiTesting.Run(folder, "Gui.xml")
    picture = os.path.join(folder, "Gui.png")
    GuiTesting.CheckPicture(picture)
    difference = ImageComparison.FindDifference(
        os.path.join(folder, "State.png"),
        os.path.join(os.environ["CDM_DATA_DIR"], "Baselines", "RegionCut.png"))
    assert difference is None, difference
    for name, expected in (("changed", [1.0, 0.0005]), ("undone", [0.0, 0.0]),
                           ("redone", [1.0, 0.0005])):
        found = GetOptions(os.path.join(folder, name + ".pvsm"))
        assert found == expected, (name, found)
    shutil.copy(picture, os.path.join(os.environ["CDM_OUTPUT_DIR"], "Gui.png"))
print("gui: ok")
sys.exit(0)
