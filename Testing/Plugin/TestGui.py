# SPDX-License-Identifier: BSD-3-Clause
"""The real ParaView: loads the plugin, makes a device, meshes it by the menus, takes a picture.

Starts ParaView with the command of the README, and plays the events of Gui.xml; looks at the
picture, at the states that it saves after a change, its undoing and its redoing, and at the
picture of Plugin/Examples/mos_transistor.pvsm.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import numpy
import ImageComparison


def GetCommand():
    """The command that starts ParaView, as the README has it."""
    with open(os.path.join(os.environ["CDM_SOURCE_DIR"], "README.md"), encoding="utf-8") as readme:
        command = re.search(r"^paraview (.*--plugins=.*)$", readme.read(), re.MULTILINE)
    return [os.environ["CDM_PARAVIEW"]] + shlex.split(command.group(1))


def CheckPicture(path):
    """The device fills a good part of the middle, in several shades."""
    pixels = ImageComparison.ReadPixels(path)
    height, width, _ = pixels.shape
    background = pixels[-1, -1]
    middle = pixels[height // 4: 3 * height // 4, width // 4: 3 * width // 4]
    covered = (numpy.abs(middle - background).max(axis=2) > ImageComparison.LEVELS).mean()
    shades = len(numpy.unique(middle.reshape(-1, 3), axis=0))
    print("picture: %.0f %% covered, %d shades" % (100 * covered, shades))
    assert covered > 0.3, "the picture is all but blank"
    assert shades > 20, "the picture shows no mesh"


def GetOptions(path):
    """The options of the mesher that Gui.xml changes, as a state has them."""
    (mesher,) = [proxy for proxy in ElementTree.parse(path).getroot().iter("Proxy")
                 if proxy.get("type") == "ConformingDelaunayMesher"]
    values = {option.get("name"): [element.get("value") for element in option.iter("Element")]
              for option in mesher.iter("Property")}
    return [float(values[name][0]) for name in ("AddSteinerPoints", "MaximumVolume")]


with tempfile.TemporaryDirectory() as folder:
    # The README's command speaks of build/ in the folder of the project.
    os.symlink(os.environ["CDM_BINARY_DIR"], os.path.join(folder, "build"))
    shutil.copy(os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples",
                             "mos_transistor.pvsm"), folder)
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "Gui.xml")
    command = GetCommand() + [
        "--dr", "--test-directory=" + folder, "--test-script=" + script, "--exit"]
    print(" ".join(command))
    run = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         text=True, timeout=240)
    print(run.stdout)
    assert run.returncode == 0, "ParaView ended with %d" % run.returncode
    assert "ERROR" not in run.stdout and "ERR|" not in run.stdout, "ParaView reports an error"
    picture = os.path.join(folder, "Gui.png")
    CheckPicture(picture)
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
