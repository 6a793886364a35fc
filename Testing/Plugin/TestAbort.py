# SPDX-License-Identifier: BSD-3-Clause
"""The Abort button of the real ParaView ends a mesh, and Apply starts it again.

Plays the events of Abort.xml. As soon as the button beside the progress bar turns red, it is pressed
with the mouse, as a user does. Each run must end soon after, and leave ParaView usable: Apply starts
the same run again, and with another option the filter makes a mesh. The message beside the button is
there after an abort, and goes with the filter.
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


def CountGreenPixels():
    """Light green ones: while Apply can be pressed it has a thousand of them."""
    red, green, blue = numpy.moveaxis(GuiTesting.GrabScreen(), 2, 0)
    return int(((red > 140) & (green > red + 30) & (green > blue + 30)).sum())


def Abort():
    """Presses the button as soon as a mesh is being made, and waits until that has ended; returns
    where the button is."""
    (x, y), _ = GuiTesting.WaitFor(FindRunningMesh, START_SECONDS)
    subprocess.run([os.environ["CDM_XDOTOOL"], "mousemove", str(x), str(y), "click", "1"], check=True)
    _, seconds = GuiTesting.WaitFor(lambda: True if FindAbortButton() is None else None, SECONDS)
    print("aborted after %.1f seconds" % seconds)
    return x, y


def WaitForMessage(x, y, isThere, seconds):
    """Until there are dark letters, or none, to the left of the button."""
    def IsDone():
        bar = GuiTesting.GrabScreen()[y - 6: y + 7, 4: x - 12].max(axis=2)
        # The window is light, the screen without it black.
        letters = (bar < 120).mean()
        return True if (0.02 < letters < 0.5 if isThere else letters < 0.001) else None
    GuiTesting.WaitFor(IsDone, seconds)
    print("message %s" % ("shown" if isThere else "gone"))


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "output.txt"), "w+", encoding="utf-8") as output:
        process = GuiTesting.Start(folder, "Abort.xml", output)
        try:
            x, y = Abort()
            WaitForMessage(x, y, True, SECONDS)
            offered = CountGreenPixels()
            GuiTesting.WaitFor(lambda: True if CountGreenPixels() < offered - 500 else None, SECONDS)
            # Before the next filter runs, which takes the message away, too.
            WaitForMessage(x, y, False, 15)
            for _ in range(RUNS):
                Abort()
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
