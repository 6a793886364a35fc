# SPDX-License-Identifier: BSD-3-Clause
"""Stage 5: the via plug, cut open, by smallest dihedral angle; no sliver is left.

From red (0 degrees) over yellow to blue (60 degrees).
"""

import numpy

import Scene
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner,
    vtkSteinerPointRefiner)

device = Scene.MakeViaPlug()
triangulator = vtkBoundaryTriangulator()
triangulator.SetInputConnection(device.GetOutputPort())
refiner = vtkDelaunaySurfaceRefiner()
refiner.SetInputConnection(triangulator.GetOutputPort())
tetrahedralizer = vtkAdvancingFrontTetrahedralizer()
tetrahedralizer.SetInputConnection(refiner.GetOutputPort())
steiner = vtkSteinerPointRefiner()
steiner.SetInputConnection(tetrahedralizer.GetOutputPort())
steiner.SetMaximumEdgeLength(0.12)
steiner.SetDihedralAngleTarget(18.0)
steiner.Update()
before, after = tetrahedralizer.GetOutput(0), steiner.GetOutput()

count = before.GetNumberOfPoints()
assert (Scene.GetPoints(after)[:count] == Scene.GetPoints(before)).all()
regions = Scene.GetCellArray(after, "RegionId")
assert numpy.allclose(numpy.bincount(regions, Scene.GetVolumes(after)),
                      numpy.bincount(Scene.GetCellArray(before, "RegionId"),
                                     Scene.GetVolumes(before)), rtol=1e-12, atol=0.0)
angles = Scene.GetSmallestAngles(after)
print("%d tetrahedra, smallest angle %.1f degrees, median %.1f; %d rounds, %d points moved" % (
    len(angles), angles.min(), numpy.median(angles), steiner.GetNumberOfRounds(),
    steiner.GetNumberOfMovedPoints()))
assert angles.min() >= 18.0
corners = Scene.GetPoints(after)[Scene.GetTetrahedra(after)]
for i in range(4):
    for j in range(i):
        assert numpy.linalg.norm(corners[:, i] - corners[:, j], axis=1).max() <= 0.12

scene = Scene.Scene((0.0, 0.0, 0.3), (0.55, -1.0, 0.45), 1.75)
scene.AddTetrahedra(after, Scene.ColourByValue(angles, 0.0, 60.0),
                    keep=Scene.GetCentroids(after)[:, 1] > 0.0)
scene.Save("SteinerPointRefiner.png")
Scene.AssertSameAsBaselines("SteinerPointRefiner.png")
