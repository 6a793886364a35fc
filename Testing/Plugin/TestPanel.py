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


def WaitForState(folder, name):
    GuiTesting.WaitFor(lambda: os.path.exists(os.path.join(folder, name + ".pvsm")) or None, 200)


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "output.txt"), "w+", encoding="utf-8") as output:
        process = GuiTesting.Start(folder, "Panel.xml", output, "-qwindowgeometry", WINDOW)
        try:
            for name in ("PanelDefault", "PanelAdvanced"):
                WaitForState(folder, name)
                # Time for ParaView to draw what it shows.
                time.sleep(3)
                subprocess.run([os.environ["CDM_IMPORT"], "-window", "root", "-crop", PANEL, "+repage",
                                "-strip", os.path.join(os.environ["CDM_OUTPUT_DIR"], name + ".png")],
                               check=True)
            status = process.wait(120)
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
