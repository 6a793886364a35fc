# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the real ParaView share: how it is started, and how its picture looks."""

import os
import re
import shlex
import subprocess
import time

import ImageComparison
import numpy


def GetCommand():
    """The command that starts ParaView, as the README has it."""
    with open(os.path.join(os.environ["CDM_SOURCE_DIR"], "README.md"), encoding="utf-8") as readme:
        command = re.search(r"^paraview (.*--plugins=.*)$", readme.read(), re.MULTILINE)
    return [os.environ["CDM_PARAVIEW"]] + shlex.split(command.group(1))


def Start(folder, events, output, *options):
    """ParaView in `folder`, where it plays a file of events beside this one, and writes what the
    events ask for; all that it says goes into the file `output`."""
    # The README's command speaks of build/ in the folder of the project.
    os.symlink(os.environ["CDM_BINARY_DIR"], os.path.join(folder, "build"))
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), events)
    command = GetCommand() + [
        "--dr", "--test-directory=" + folder, "--test-script=" + script, "--exit", *options]
    print(" ".join(command))
    return subprocess.Popen(command, cwd=folder, stdout=output, stderr=subprocess.STDOUT)


def Run(folder, events, seconds=540, failures=()):
    """Starts ParaView as above, waits until it ends, and checks that all went well, but for errors
    with one of the texts `failures`."""
    with open(os.path.join(folder, "output.txt"), "w+", encoding="utf-8") as output:
        process = Start(folder, events, output)
        try:
            status = process.wait(seconds)
        finally:
            process.kill()
            output.seek(0)
            text = output.read()
            print(text)
        CheckOutput(status, "\n".join(
            line for line in text.splitlines() if not any(failure in line for failure in failures)))


def GrabScreen():
    grab = subprocess.run([os.environ["CDM_IMPORT"], "-window", "root", "-depth", "8", "ppm:-"],
                          stdout=subprocess.PIPE, check=True)
    _, size, _, pixels = grab.stdout.split(b"\n", 3)
    width, height = map(int, size.split())
    return numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 3).astype(int)


def WaitFor(condition, seconds):
    """The first answer of `condition` that is not None, and after how long it came."""
    start = time.monotonic()
    while time.monotonic() - start < seconds:
        answer = condition()
        if answer is not None:
            return answer, time.monotonic() - start
        time.sleep(0.5)
    raise AssertionError("nothing happened for %d seconds" % seconds)


def CheckOutput(status, text):
    assert status == 0, "ParaView ended with %d" % status
    assert "ERROR" not in text and "ERR|" not in text, "ParaView reports an error"


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
