# SPDX-License-Identifier: BSD-3-Clause
"""A plate 12 times as wide as thick, cut open, with three answers to how it is filled.

From below: as a thin layer, with tetrahedra from side to side; with well shaped ones, which is the
default; with at least two across. Colored by smallest dihedral angle, from red (0 degrees) over
yellow to blue (40 degrees).
"""

import numpy

import Scene
from conforming_delaunay import vtkConformingDelaunayMesher
from vtkmodules.vtkFiltersSources import vtkCubeSource

WIDTH, THICKNESS = 1.0, 0.08
plate = vtkCubeSource()
plate.SetOutputPointsPrecision(1)  # double
plate.SetXLength(WIDTH)
plate.SetYLength(WIDTH)
plate.SetZLength(THICKNESS)
mesher = vtkConformingDelaunayMesher()
mesher.SetInputConnection(plate.GetOutputPort())
mesher.SetMeshForToFewestPoints()
mesher.SetCriterionToSmallestSphere()
mesher.AddSteinerPointsOn()

scene = Scene.Scene((0.04, 0.25, 0.25), (0.2, -1.0, 0.3), 0.96)
for level, (ratio, across) in enumerate(((10.0, 1), (0.0, 1), (0.0, 2))):
    mesher.SetLayerAspectRatio(ratio)
    mesher.SetTetrahedraAcrossLayers(across)
    # A size, so that there is something to see where the layer is left as it is.
    mesher.SetMaximumEdgeLength(0.45 if level == 0 else 0.0)
    mesher.Update()
    mesh = Scene.Copy(mesher.GetOutput())
    angles = Scene.GetSmallestAngles(mesh)
    heights = Scene.GetPoints(mesh)[:, 2]
    low, high = heights == heights.min(), heights == heights.max()
    tetrahedra = Scene.GetTetrahedra(mesh)
    reached, steps = low, 0
    while not (reached & high).any():
        reached = reached.copy()
        reached[tetrahedra[reached[tetrahedra].any(axis=1)]] = True
        steps += 1
    print("%d tetrahedra, %d across, smallest angle %.1f degrees" % (
        len(tetrahedra), steps, angles.min()))
    assert steps >= across
    assert (angles.min() < 15.0) == (level == 0)
    keep = Scene.GetCentroids(mesh)[:, 1] > 0.0
    points = Scene.GetPoints(mesh)
    points[:, 2] += 0.25 * level
    scene.AddTetrahedra(mesh, Scene.ColourByValue(angles, 0.0, 40.0), keep=keep)
scene.Save("ThinLayers.png")
Scene.AssertSameAsBaselines("ThinLayers.png")
