# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/growing_oxide.py writes its frames and its mesh: an oxide that is there at the end."""

import os
import subprocess
import sys
import tempfile

import ImageComparison

with tempfile.TemporaryDirectory() as folder:
    script = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples", "growing_oxide.py")
    run = subprocess.run([os.environ["CDM_PVPYTHON"], script, folder, "3"], timeout=240,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(run.stdout)
    if run.returncode != 0 or "ERR|" in run.stdout or "Traceback" in run.stdout:
        sys.exit("exit code %d" % run.returncode)
    frames = ["growing_oxide_%04d.png" % i for i in range(3)]
    assert sorted(os.listdir(folder)) == ["growing_oxide.vtu", *frames], os.listdir(folder)
    pictures = [ImageComparison.ReadPixels(os.path.join(folder, name)) for name in frames]


def CountYellow(pixels):
    """Pixels of the oxide."""
    return int(((pixels[:, :, 0] > 150) & (pixels[:, :, 2] < 0.6 * pixels[:, :, 0])).sum())


counts = [CountYellow(pixels) for pixels in pictures]
print("yellow pixels:", counts)
assert 10000 < counts[0] < counts[1] - 10000 < counts[2] - 20000
