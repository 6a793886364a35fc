# SPDX-License-Identifier: BSD-3-Clause
"""Stage 3: the front on its way through the MOS transistor, and the finished mesh cut open."""

import numpy

import ImageComparison
import Scene
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner)

device = Scene.MakeMosTransistor()
triangulator = vtkBoundaryTriangulator()
triangulator.SetInputConnection(device.GetOutputPort())
refiner = vtkDelaunaySurfaceRefiner()
refiner.SetInputConnection(triangulator.GetOutputPort())
refiner.SetMaximumEdgeLength(0.06)
tetrahedralizer = vtkAdvancingFrontTetrahedralizer()
tetrahedralizer.SetInputConnection(refiner.GetOutputPort())
tetrahedralizer.Update()
mesh = Scene.Copy(tetrahedralizer.GetOutput(0))

volumes = Scene.GetVolumes(mesh)
assert (volumes > 0.0).all(), "%d tetrahedra are inverted or flat" % (volumes <= 0.0).sum()
regions = Scene.GetCellArray(mesh, "RegionId")
assert numpy.allclose(numpy.bincount(regions, volumes),
                      Scene.GetRegionVolumes(device.GetOutput(), 5), rtol=1e-9, atol=0.0)
assert tetrahedralizer.GetNumberOfRegions() == 5
assert tetrahedralizer.GetOutputDataObject(2).GetNumberOfCells() == 0, "the front is not empty"
# The boundary of the mesh is the surface, on the same points.
surface = refiner.GetOutput(0)
assert (Scene.GetPoints(mesh) == Scene.GetPoints(surface)).all()
assert (Scene.GetSortedTriangles(tetrahedralizer.GetOutputDataObject(1))
        == Scene.GetSortedTriangles(surface)).all()

scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
scene.AddSurface(Scene.ExtractOutside(Scene.ColourByRegion(
    Scene.CutOpen(mesh, 1, 0.15), Scene.MOS_COLOURS)), edges=True)
scene.Save(Scene.GetOutputPath("AdvancingFrontTetrahedralizer.png"))

# Stopped half way: what is there is part of the finished mesh, and the front lies around it.
half = mesh.GetNumberOfCells() // 2
tetrahedralizer.SetMaximumNumberOfTetrahedra(half)
tetrahedralizer.Update()
part, front = tetrahedralizer.GetOutput(0), tetrahedralizer.GetOutputDataObject(2)
assert half <= part.GetNumberOfCells() < mesh.GetNumberOfCells()
assert (Scene.GetTetrahedra(part) == Scene.GetTetrahedra(mesh)[:part.GetNumberOfCells()]).all()
assert front.GetNumberOfCells() > 0

scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
Scene.DrawFront(scene, part, front, Scene.MOS_COLOURS)
scene.AddWire(device.GetOutput())
scene.Save(Scene.GetOutputPath("AdvancingFrontTetrahedralizerFront.png"))

for picture in ("", "Front"):
    ImageComparison.AssertSameAsBaseline("AdvancingFrontTetrahedralizer%s.png" % picture)
