# SPDX-License-Identifier: BSD-3-Clause
"""Voxels of a lined trench: their staircase, smooth interfaces, and few triangles; regions apart."""

import os
import sys

import numpy

import Scene
from conforming_delaunay import vtkMaterialInterfaceExtractor

sys.path.insert(0, os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples"))
import voxel_topography  # noqa: E402 (found in the folder above)

COLOURS = ((0.49, 0.65, 0.84), (0.96, 0.74, 0.24), (0.82, 0.34, 0.32))
SHIFTS = ((0.0, 0.0, -0.12), (0.0, 0.0, 0.06), (0.0, 0.0, 0.24))

materials = voxel_topography.SimulateTopography()
image = voxel_topography.MakeImage(materials)
voxel = voxel_topography.VOXEL
volumes = numpy.bincount(materials[materials >= 0]) * voxel**3


def Extract(length, reduce, deviation):
    extractor = vtkMaterialInterfaceExtractor()
    extractor.SetInputData(image)
    extractor.SetSmoothingLength(length)
    extractor.SetReduceSurface(reduce)
    extractor.SetMaximumDeviation(deviation)
    extractor.Update()
    return extractor


def Draw(surface, name):
    scene = Scene.Scene((0.32, 0.16, 0.2), (0.5, -1.0, 0.9), 0.86)
    for region, (colour, shift) in enumerate(zip(COLOURS, SHIFTS)):
        scene.AddSurface(Scene.GetRegionSurface(surface, region, shift), colour, edges=True)
    scene.Save(name)


def GetRoundness(surface):
    """Root mean square height of the points of the round wall of silicon over a cone, in voxels."""
    points = Scene.GetPoints(surface) / voxel
    isWall = numpy.zeros(len(points), dtype=bool)
    for ids, labels in zip(Scene.GetPolygons(surface), Scene.GetCellArray(surface, "BoundaryLabels")):
        if tuple(labels) == (voxel_topography.SILICON, voxel_topography.OXIDE):
            isWall[ids] = True
    isWall &= (points[:, 0] > 43.0) & (points[:, 2] > 14.0) & (points[:, 2] < 28.0)
    x, y, z = points[isWall].T
    radius = numpy.hypot(x - 40.0, y - 16.0)
    return numpy.sqrt(numpy.mean((radius - (10.0 - 0.15 * (32.0 - z))) ** 2))


stairs = Extract(0.0, True, 0.0)
assert numpy.allclose(Scene.GetRegionVolumes(stairs.GetOutput(), 3), volumes, rtol=1e-12, atol=0.0)
assert stairs.GetOutput().GetNumberOfCells() < stairs.GetNumberOfFaces() / 10
Draw(stairs.GetOutput(), "MaterialInterfaceStairs.png")

full = Extract(10.0, False, 0.0)
few = Extract(10.0, True, 0.25)
assert full.GetOutput().GetNumberOfCells() == 2 * full.GetNumberOfFaces()
assert few.GetLargestDeviation() <= 0.25 * voxel
assert few.GetOutput().GetNumberOfCells() < stairs.GetNumberOfFaces() / 5
# The layers are three and four voxels thick; edges become rounder.
for surface in full, few:
    errors = Scene.GetRegionVolumes(surface.GetOutput(), 3) / volumes - 1.0
    print("volume errors", errors, "height", GetRoundness(surface.GetOutput()))
    assert (numpy.abs(errors) < 0.02).all()
exact = Extract(0.0, False, 0.0)
print("height of the stairs", GetRoundness(exact.GetOutput()))
assert GetRoundness(full.GetOutput()) < 0.4 * GetRoundness(exact.GetOutput())
Draw(few.GetOutput(), "MaterialInterfaces.png")
Scene.AssertSameAsBaselines("MaterialInterfaceStairs.png", "MaterialInterfaces.png")
