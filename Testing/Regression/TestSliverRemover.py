# SPDX-License-Identifier: BSD-3-Clause
"""Stage 4: the tetrahedra of the MOS transistor, cut open, by smallest dihedral angle.

From red (0 degrees) over yellow to blue (60 degrees). Red is the gate oxide, a layer of flat
tetrahedra on purpose; a red tetrahedron elsewhere is a sliver.
"""

import numpy

import Scene
from conforming_delaunay import vtkSliverRemover

device = Scene.MakeMosTransistor()
_, tetrahedralizer = Scene.MakeMosTetrahedralizer(device)
remover = vtkSliverRemover()
remover.SetInputConnection(tetrahedralizer.GetOutputPort())
remover.Update()
before, after = tetrahedralizer.GetOutput(0), remover.GetOutput()

assert (Scene.GetPoints(after) == Scene.GetPoints(before)).all()
volumes = Scene.GetVolumes(after)
assert (volumes > 0.0).all(), "%d tetrahedra are inverted or flat" % (volumes <= 0.0).sum()
regions = Scene.GetCellArray(after, "RegionId")
assert numpy.allclose(numpy.bincount(regions, volumes),
                      Scene.GetRegionVolumes(device.GetOutput(), 5), rtol=1e-9, atol=0.0)
angles = Scene.GetSmallestAngles(before), Scene.GetSmallestAngles(after)
print("under 5, 10, 15 degrees: before %s, after %s" % tuple(
    [int((some < limit).sum()) for limit in (5, 10, 15)] for some in angles))
assert remover.GetNumberOfFlips() > 0
# The worst ones get better: in rising order the first angle that has changed has grown.
old, new = (numpy.sort(some)[:min(map(len, angles))] for some in angles)
changed = numpy.flatnonzero(numpy.abs(new - old) > 1e-6)
assert len(changed) > 0 and new[changed[0]] > old[changed[0]]
assert abs(angles[0].min() - remover.GetSmallestDihedralAngleBefore()) < 1e-6
assert abs(angles[1].min() - remover.GetSmallestDihedralAngleAfter()) < 1e-6

scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
scene.AddTetrahedra(after, Scene.ColourByValue(angles[1], 0.0, 60.0),
                    keep=Scene.GetCentroids(after)[:, 1] > 0.15)
scene.Save("SliverRemover.png")
Scene.AssertSameAsBaselines("SliverRemover.png")
