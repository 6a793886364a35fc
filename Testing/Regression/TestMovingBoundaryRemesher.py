# SPDX-License-Identifier: BSD-3-Clause
"""Moving boundaries: an oxide that has grown on silicon beside a mask, in two time steps, cut open.

The model is that of Plugin/Examples/growing_oxide.py.
"""

import os
import sys

import numpy

import Scene

sys.path.insert(0, os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples"))
import growing_oxide

before, boundary = growing_oxide.MakeMesh()
after = before
for begin, end in ((0.0, 0.4), (0.4, 1.0)):
    remesher = growing_oxide.Move(after, boundary, begin, end)
    after, boundary = remesher.GetOutputDataObject(0), remesher.GetOutputDataObject(1)
    assert remesher.GetNumberOfTopologyChanges() == 0
    assert remesher.GetNumberOfUnresolvedTriangles() == 0
    faults = growing_oxide.CountFaults(after, boundary)
    print(after.GetNumberOfCells(), "tetrahedra,", faults)
    assert not any(faults[name] for name in faults if name != "NegativeCouplings"), faults

# The oxide has the volume of its profile, the silicon has lost 0.44 of what has grown: but for the
# curvature of the profile within an edge, of which triangles know nothing.
places = numpy.linspace(-growing_oxide.LENGTH, growing_oxide.LENGTH, 4001)
thickness = growing_oxide.GetThickness(places, 1.0)
grown = growing_oxide.WIDTH * numpy.trapz(thickness, places)
volumes = [numpy.bincount(Scene.GetCellArray(mesh, "RegionId"), Scene.GetVolumes(mesh))
           for mesh in (before, after)]
changes = volumes[1] - volumes[0]
print("oxide grown:", changes[1], "of", grown, "silicon taken:", -changes[0])
assert abs(changes[1] - grown) < 0.01 * grown
assert abs(changes[0] + growing_oxide.BOTTOM * grown) < 0.01 * grown
assert (Scene.GetVolumes(after) > 0.0).all()

scene = Scene.Scene((0.0, 0.2, -0.18), (-0.3, -1.0, 0.5), 1.1)
scene.AddTetrahedra(after, Scene.ColourByRegion(after, Scene.MOS_COLOURS),
                    keep=Scene.GetCentroids(after)[:, 1] > 0.4 * growing_oxide.WIDTH)
scene.Save("MovingBoundaryRemesher.png")
Scene.AssertSameAsBaselines("MovingBoundaryRemesher.png")
