# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/advancing_front.py writes its frames: two of them, in which something is seen."""

import os
import subprocess
import sys
import tempfile

import ImageComparison

with tempfile.TemporaryDirectory() as folder:
    script = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples", "advancing_front.py")
    run = subprocess.run([os.environ["CDM_PVPYTHON"], script, folder, "2"], timeout=240,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(run.stdout)
    if run.returncode != 0 or "ERR|" in run.stdout or "Traceback" in run.stdout:
        sys.exit("exit code %d" % run.returncode)
    frames = sorted(os.listdir(folder))
    assert frames == ["advancing_front_0000.png", "advancing_front_0001.png"], frames
    half, whole = (ImageComparison.ReadPixels(os.path.join(folder, name)) for name in frames)
    for name in frames:
        assert not ImageComparison.IsBlank(os.path.join(folder, name)), name

# The front is orange, and gone at the end; the rest of the bulk and all of the gate come after it.
def CountOrange(pixels):
    return int(((pixels[:, :, 0] > 150) & (pixels[:, :, 2] < 0.4 * pixels[:, :, 0])
                & (pixels[:, :, 1] < 0.75 * pixels[:, :, 0])
                & (pixels[:, :, 1] > 0.5 * pixels[:, :, 0])).sum())


print("orange pixels:", CountOrange(half), CountOrange(whole))
assert CountOrange(half) > 5000 > 100 > CountOrange(whole)
assert ImageComparison.CountDifferentPixels(half, whole) > 50000
