# SPDX-License-Identifier: BSD-3-Clause
"""Stage 3: the front on its way through the MOS transistor, and the finished mesh cut open.

Mesh points on a body-centred lattice in bulk and gate make tetrahedra of good shape there.
"""

import numpy

import Scene

device = Scene.MakeMosTransistor()
refiner, tetrahedralizer = Scene.MakeMosTetrahedralizer(device)
tetrahedralizer.Update()
mesh = Scene.Copy(tetrahedralizer.GetOutput(0))

volumes = Scene.GetVolumes(mesh)
assert (volumes > 0.0).all(), "%d tetrahedra are inverted or flat" % (volumes <= 0.0).sum()
regions = Scene.GetCellArray(mesh, "RegionId")
assert numpy.allclose(numpy.bincount(regions, volumes),
                      Scene.GetRegionVolumes(device.GetOutput(), 5), rtol=1e-9, atol=0.0)
assert tetrahedralizer.GetNumberOfRegions() == 5
assert tetrahedralizer.GetOutputDataObject(2).GetNumberOfCells() == 0, "the front is not empty"
# The boundary is the surface, but for diagonals of cocircular points that were turned, and the
# outside of the mesh is that part of the boundary which has the outside in front.
surface = refiner.GetOutput(0)
kept = refiner.GetOutput(2)
assert kept.GetNumberOfPoints() == Scene.MakeMeshPoints().GetNumberOfPoints()
assert (Scene.GetPoints(mesh) == numpy.concatenate(
    (Scene.GetPoints(surface), Scene.GetPoints(kept)))).all()
boundary = Scene.Copy(tetrahedralizer.GetOutputDataObject(1))
triangles = set(map(tuple, Scene.GetSorted(Scene.GetPolygons(boundary))))
turned = triangles.symmetric_difference(
    map(tuple, Scene.GetSorted(Scene.GetPolygons(surface))))
assert len(triangles) == surface.GetNumberOfCells()
assert len(turned) <= 4 * tetrahedralizer.GetNumberOfTurnedDiagonals()
labels = Scene.GetCellArray(boundary, "BoundaryLabels")
walls = numpy.array(Scene.GetPolygons(boundary))[labels[:, 0] == -1]
faces, _ = Scene.GetOutsideFaces(Scene.GetTetrahedra(mesh))
assert (Scene.GetSorted(faces) == Scene.GetSorted(walls)).all(), "holes, or faces too many"

scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
scene.AddTetrahedra(mesh, Scene.ColourByRegion(mesh, Scene.MOS_COLOURS),
                    keep=Scene.GetCentroids(mesh)[:, 1] > 0.15)
scene.Save("AdvancingFrontTetrahedralizer.png")

# Stopped half way: what is there is part of the finished mesh, and its outside is the front and
# parts of the surface.
half = mesh.GetNumberOfCells() // 2
tetrahedralizer.SetMaximumNumberOfTetrahedra(half)
tetrahedralizer.Update()
part, front = tetrahedralizer.GetOutputDataObject(0), tetrahedralizer.GetOutputDataObject(2)
assert half <= part.GetNumberOfCells() < mesh.GetNumberOfCells()


def GetCells(cells, data):
    """Cells as a set of sorted ids of the points of the finished mesh."""
    return set(map(tuple, Scene.GetSorted(Scene.FindPoints(mesh, data)[numpy.array(cells)])))


finished = GetCells(Scene.GetTetrahedra(mesh), mesh)
assert finished.issuperset(GetCells(Scene.GetTetrahedra(part), part))
outside = GetCells(Scene.GetOutsideFaces(Scene.GetTetrahedra(part))[0], part)
border = GetCells(Scene.GetPolygons(front), front)
assert border and border <= outside
assert outside - border <= triangles

scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
scene.AddTetrahedra(part, Scene.ColourByRegion(part, Scene.MOS_COLOURS), front=front)
scene.AddWire(device.GetOutput())
scene.Save("AdvancingFrontTetrahedralizerFront.png")

Scene.AssertSameAsBaselines(
    "AdvancingFrontTetrahedralizer.png", "AdvancingFrontTetrahedralizerFront.png")
