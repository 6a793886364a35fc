# SPDX-License-Identifier: BSD-3-Clause
"""The panel of the mesher in the real ParaView looks as it should: as it opens, and with all options.

Plays the events of Panel.xml in a window that fills the screen, and compares pictures of the part
of the screen with the properties with their baselines.
"""

import os
import subprocess
import sys
import tempfile
import time

import GuiTesting
import ImageComparison

WINDOW = "1280x1024+0+0"
PANEL = "300x560+0+440"  # width, height, left and top


SECONDS = 17  # ParaView shows the panel for a little longer


def WaitForState(folder, name):
    GuiTesting.WaitFor(lambda: os.path.exists(os.path.join(folder, name + ".pvsm")) or None, 240)


def TakePicture(name):
    """As soon as ParaView has drawn what is expected; if it does not, at the end."""
    picture = os.path.join(os.environ["CDM_OUTPUT_DIR"], name)
    baseline = ImageComparison.GetBaseline(name)
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        subprocess.run([os.environ["CDM_IMPORT"], "-window", "root", "-crop", PANEL, "+repage",
                        "-strip", picture], check=True)
        if ImageComparison.FindDifference(picture, baseline) is None:
            return
        time.sleep(0.5)


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "output.txt"), "w+", encoding="utf-8") as output:
        process = GuiTesting.Start(folder, "Panel.xml", output, "-qwindowgeometry", WINDOW)
        try:
            for name in ("PanelDefault", "PanelAdvanced"):
                WaitForState(folder, name)
                TakePicture(name + ".png")
            status = process.wait(240)
        finally:
            process.kill()
            output.seek(0)
            text = output.read()
            print(text)
    GuiTesting.CheckOutput(status, text)
for name in ("PanelDefault.png", "PanelAdvanced.png"):
    ImageComparison.AssertSameAsBaseline(name)
print("panel: ok")
sys.exit(0)
