# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/voxel_topography.py turns voxels into a valid mesh, and draws both."""

import os
import re
import subprocess
import sys
import tempfile

import ImageComparison

with tempfile.TemporaryDirectory() as folder:
    script = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples", "voxel_topography.py")
    run = subprocess.run([os.environ["CDM_PVPYTHON"], script, folder], timeout=240,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(run.stdout)
    if run.returncode != 0 or "ERR|" in run.stdout or "Traceback" in run.stdout:
        sys.exit("exit code %d" % run.returncode)
    names = ["voxel_topography.png", "voxel_topography.vtu", "voxel_topography_voxels.png"]
    assert sorted(os.listdir(folder)) == names, os.listdir(folder)
    mesh, voxels = (ImageComparison.ReadPixels(os.path.join(folder, name))
                    for name in (names[0], names[2]))

# Of each material as much as there are voxels, but for edges that become rounder.
for before, after in re.findall(r"voxels +(\S+) um\^3, +\d+ tetrahedra +(\S+) um\^3", run.stdout):
    assert abs(float(after) / float(before) - 1.0) < 0.02, (before, after)
assert run.stdout.count("um^3, ") == 3
assert re.search("^(DELAUNAY|CLEAN FOR FINITE VOLUMES)", run.stdout, re.MULTILINE), run.stdout


def CountColours(pixels):
    """Pixels of silicon, oxide and tungsten."""
    red, green, blue = (pixels[:, :, i].astype(int) for i in range(3))
    return [int(mask.sum()) for mask in (
        blue > red + 30, (red > blue + 60) & (green > blue + 30),
        (red > green + 30) & (red > blue + 30) & (green < blue + 30))]


for pixels in (mesh, voxels):
    counts = CountColours(pixels)
    print("pixels of silicon, oxide, tungsten:", counts)
    assert min(counts) > 15000
