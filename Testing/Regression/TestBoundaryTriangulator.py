# SPDX-License-Identifier: BSD-3-Clause
"""Stage 0: the triangles of the MOS transistor, its regions moved apart."""

import numpy

import Scene
from conforming_delaunay import vtkBoundaryTriangulator

device = Scene.MakeMosTransistor()
triangulator = vtkBoundaryTriangulator()
triangulator.SetInputConnection(device.GetOutputPort())
triangulator.Update()
surface = triangulator.GetOutput(0)

# A polygon of n corners gives n - 2 triangles; no point is new.
polygons = Scene.GetPolygons(device.GetOutput())
triangles = Scene.GetPolygons(surface)
assert {len(ids) for ids in triangles} == {3}
assert len(triangles) == sum(len(ids) - 2 for ids in polygons) == 72
assert (Scene.GetPoints(surface) == Scene.GetPoints(device.GetOutput())).all()
assert triangulator.GetOutput(1).GetNumberOfCells() == 0, "problems"
assert numpy.allclose(Scene.GetRegionVolumes(surface, 5),
                      Scene.GetRegionVolumes(device.GetOutput(), 5), rtol=1e-12, atol=0.0)

scene = Scene.Scene((0.0, 0.15, -0.12), (0.45, -1.0, 0.5), 1.1)
for region, (colour, shift) in enumerate(zip(Scene.MOS_COLOURS, Scene.MOS_SHIFTS)):
    scene.AddSurface(Scene.GetRegionSurface(surface, region, shift), colour, edges=True)
scene.Save("BoundaryTriangulator.png")
Scene.AssertSameAsBaselines("BoundaryTriangulator.png")
