# SPDX-License-Identifier: BSD-3-Clause
"""Which tetrahedra are excused from the limits on shape: RefinementFault 4 of vtkSteinerPointRefiner.

From below: a wedge of 12 degrees; a bulk under a layer a fiftieth as thick as long. Both are cut
open. Red tetrahedra are excused: each has points on both sides of the wedge or of the layer. Blue
ones fulfil the limits.
"""

import numpy

import Scene
from conforming_delaunay import vtkConformingDelaunayMesher
from vtkmodules.util.numpy_support import numpy_to_vtk

INEVITABLE = 4
DEPTH, HEIGHT, THICKNESS = 0.4, 0.3, 0.02
EXCUSED, FULFILLED = (0.82, 0.34, 0.32), (0.49, 0.65, 0.84)
SLOPE = numpy.tan(numpy.radians(12.0))


def Extrude(outline):
    """Points of an outline in x and z, at the front and the back."""
    return numpy.array([(x, y, z) for y in (-0.5 * DEPTH, 0.5 * DEPTH) for x, z in outline])


wedge = Scene.MakeSurface(
    Extrude(((0.0, 0.0), (1.0, 0.0), (1.0, SLOPE))),
    ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)))
layer = Scene.MakeSurface(
    Extrude(((0.0, 0.0), (1.0, 0.0), (1.0, HEIGHT), (0.0, HEIGHT), (1.0, HEIGHT + THICKNESS),
             (0.0, HEIGHT + THICKNESS))),
    ((0, 1, 2, 3), (6, 9, 8, 7), (0, 6, 7, 1), (1, 7, 8, 2), (3, 9, 6, 0), (3, 2, 8, 9),
     (3, 2, 4, 5), (9, 11, 10, 8), (2, 8, 10, 4), (5, 11, 9, 3), (5, 4, 10, 11)))
OUTSIDE, BULK, LAYER = -1, 0, 1
labels = numpy.array([(OUTSIDE, BULK)] * 5 + [(LAYER, BULK)] + [(OUTSIDE, LAYER)] * 5)
array = numpy_to_vtk(labels, deep=True)
array.SetName("BoundaryLabels")
layer.GetCellData().AddArray(array)

mesher = vtkConformingDelaunayMesher()
mesher.SetMeshForToFewestPoints()
mesher.SetCriterionToSmallestSphere()
mesher.AddSteinerPointsOn()
mesher.SetMaximumEdgeLength(0.15)


def IsOnSidesOfWedge(points):
    """Whether points lie on the lower and on the upper side."""
    x, z = points[..., 0], points[..., 2]
    return abs(z) < 1e-12, abs(z - SLOPE * x) < 1e-12


def IsOnSidesOfLayer(points):
    """Whether points lie on the lower and on the upper side."""
    z = points[..., 2]
    return abs(z - HEIGHT) < 1e-12, abs(z - HEIGHT - THICKNESS) < 1e-12


scene = Scene.Scene((0.5, 0.0, 0.33), (0.12, -1.0, 0.25), 0.84)
for surface, shift, isOnSides in (
        (wedge, 0.0, IsOnSidesOfWedge), (layer, 0.36, IsOnSidesOfLayer)):
    mesher.SetInputData(surface)
    mesher.Update()
    mesh = Scene.Copy(mesher.GetOutput())
    excused = Scene.GetCellArray(mesh, "RefinementFault") == INEVITABLE
    corners = Scene.GetPoints(mesh)[Scene.GetTetrahedra(mesh)]
    low, high = isOnSides(corners[excused])
    assert low.any(axis=1).all() and high.any(axis=1).all()
    assert excused.any() and not excused.all()
    print("%d of %d tetrahedra are excused" % (excused.sum(), len(excused)))
    keep = Scene.GetCentroids(mesh)[:, 1] > 0.0
    points = Scene.GetPoints(mesh)
    points[:, 2] += shift
    scene.AddTetrahedra(mesh, numpy.where(excused[:, None], EXCUSED, FULFILLED), keep=keep)
scene.Save("InevitableTetrahedra.png")
Scene.AssertSameAsBaselines("InevitableTetrahedra.png")
