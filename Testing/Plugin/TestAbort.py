# SPDX-License-Identifier: BSD-3-Clause
"""The Abort button of the real ParaView ends a mesh, and Apply starts it again.

Plays the events of Abort.xml. As soon as the button beside the progress bar turns red, it is pressed
with the mouse, as a user does. Each run must end soon after, and leave ParaView usable: Apply starts
the same run again, and with another option the filter makes a mesh.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time

import GuiTesting
import numpy

RUNS = 2
START_SECONDS = 240  # on a machine that has much else to do
SECONDS = 60  # far less than the mesh would take


def FindAbortButton():
    """The middle of the red cross below the render view: (x, y); None while it is gray."""
    red, green, blue = numpy.moveaxis(GuiTesting.GrabScreen(), 2, 0)
    top = 2 * red.shape[0] // 3
    rows, columns = numpy.nonzero((red > 150) & (green < 90) & (blue < 90) &
                                  (numpy.arange(red.shape[0])[:, None] > top))
    if len(rows) < 20:
        return None
    return int(numpy.median(columns)), int(numpy.median(rows))


def FindRunningMesh():
    """The button, if it stays red: that of a source is red for a moment only."""
    if FindAbortButton() is None:
        return None
    time.sleep(2)
    return FindAbortButton()


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "output.txt"), "w+", encoding="utf-8") as output:
        process = GuiTesting.Start(folder, "Abort.xml", output)
        try:
            for _ in range(RUNS):
                (x, y), _ = GuiTesting.WaitFor(FindRunningMesh, START_SECONDS)
                subprocess.run([os.environ["CDM_XDOTOOL"], "mousemove", str(x), str(y),
                                "click", "1"], check=True)
                _, seconds = GuiTesting.WaitFor(lambda: True if FindAbortButton() is None else None, SECONDS)
                print("aborted after %.1f seconds" % seconds)
            status = process.wait(START_SECONDS)
        finally:
            process.kill()
            output.seek(0)
            text = output.read()
            print(text)
    GuiTesting.CheckOutput(status, text)
    picture = os.path.join(folder, "Abort.png")
    GuiTesting.CheckPicture(picture)
    shutil.copy(picture, os.path.join(os.environ["CDM_OUTPUT_DIR"], "Abort.png"))
print("abort: ok")
sys.exit(0)
