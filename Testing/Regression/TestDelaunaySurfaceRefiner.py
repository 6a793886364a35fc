# SPDX-License-Identifier: BSD-3-Clause
"""Stage 2: the Delaunay surface of the MOS transistor, by region, and a look at its thin oxide."""

import numpy

import Scene
from conforming_delaunay import vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner

LENGTH = 0.06

device = Scene.MakeMosTransistor()
triangulator = vtkBoundaryTriangulator()
triangulator.SetInputConnection(device.GetOutputPort())
refiner = vtkDelaunaySurfaceRefiner()
refiner.SetInputConnection(triangulator.GetOutputPort())
refiner.SetMaximumEdgeLength(LENGTH)
refiner.Update()
surface = refiner.GetOutput(0)

points = Scene.GetPoints(surface)
triangles = numpy.array(Scene.GetPolygons(surface))
lengths = numpy.linalg.norm(points[triangles] - points[numpy.roll(triangles, 1, axis=1)], axis=2)
# Coarse is no fault: where no point can be made an edge may stay too long.
assert lengths.max() <= LENGTH * (1.0 + 1e-12), lengths.max()
assert refiner.GetNumberOfUnresolvedTriangles() == 0
before = Scene.GetPoints(triangulator.GetOutput())
assert (points[:len(before)] == before).all(), "points of the input have moved"
assert len(points) == (
    len(before) + refiner.GetNumberOfEdgePoints() + refiner.GetNumberOfFacetPoints())
assert numpy.allclose(Scene.GetRegionVolumes(surface, 5),
                      Scene.GetRegionVolumes(device.GetOutput(), 5), rtol=1e-9, atol=0.0)

scene = Scene.Scene((0.0, 0.15, -0.12), (0.45, -1.0, 0.5), 1.1)
for region, (colour, shift) in enumerate(zip(Scene.MOS_COLOURS, Scene.MOS_SHIFTS)):
    scene.AddSurface(Scene.GetRegionSurface(surface, region, shift), colour, edges=True)
scene.Save("DelaunaySurfaceRefiner.png")

# The corner of gate, spacer, oxide and bulk: 5 nm of oxide are 25 pixels high.
scene = Scene.Scene((0.12, 0.0, 0.005), (0.25, -1.0, 0.25), 0.08)
for region, colour in enumerate(Scene.MOS_COLOURS):
    scene.AddSurface(Scene.GetRegionSurface(surface, region), colour, edges=True)
scene.Save("DelaunaySurfaceRefinerOxide.png")

Scene.AssertSameAsBaselines(
    "DelaunaySurfaceRefiner.png", "DelaunaySurfaceRefinerOxide.png")
