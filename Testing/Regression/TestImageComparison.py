# SPDX-License-Identifier: BSD-3-Clause
"""The comparison of pictures sees a missing triangle, and nothing where nothing has changed.

Triangles in sight are taken out of the surface of a MOS transistor one at a time, as large in the
picture as those of the other tests.
"""

import ImageComparison
import numpy
import Scene
from conforming_delaunay import vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner

DIRECTION = (0.45, -1.0, 0.5)


def Draw(points, triangles, name):
    """A picture of the surface; its pixels."""
    scene = Scene.Scene((0.0, 0.15, -0.12), DIRECTION, 1.1)
    scene.AddSurface(Scene.MakeSurface(points, triangles), Scene.MOS_COLOURS[0], edges=True)
    return ImageComparison.ReadPixels(scene.Save(name))


device = Scene.MakeMosTransistor()
triangulator = vtkBoundaryTriangulator()
triangulator.SetInputConnection(device.GetOutputPort())
refiner = vtkDelaunaySurfaceRefiner()
refiner.SetInputConnection(triangulator.GetOutputPort())
refiner.SetMaximumEdgeLength(0.06)
refiner.Update()
surface = refiner.GetOutput(0)
points = Scene.GetPoints(surface)
triangles = numpy.array(Scene.GetPolygons(surface))
labels = Scene.GetCellArray(surface, "BoundaryLabels")
# The silicon alone is convex: what faces the camera is seen.
triangles = triangles[(labels == 0).any(axis=1)]
corners = points[triangles]
normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
centroids = corners.mean(axis=1)
outwards = numpy.sign(((centroids - (0.0, 0.15, -0.25)) * normals).sum(axis=1))
assert (outwards != 0.0).all()
triangles[outwards < 0.0] = triangles[outwards < 0.0][:, ::-1]
# Pixels that a triangle covers.
scale = Scene.HEIGHT / 1.1
sizes = 0.5 * outwards * (normals @ DIRECTION) / numpy.linalg.norm(DIRECTION) * scale**2

whole = Draw(points, triangles, "ImageComparison.png")
again = Draw(points, triangles, "ImageComparison.png")
assert (whole == again).all(), "the same picture has other pixels"

inSight = numpy.flatnonzero(sizes > 20.0)
chosen = inSight[numpy.argsort(sizes[inSight])][:: len(inSight) // 12]
counts = []
for t in chosen:
    missing = Draw(points, numpy.delete(triangles, t, axis=0), "ImageComparison.png")
    counts.append(ImageComparison.CountDifferentPixels(whole, missing))
print("triangles of %s pixels" % sizes[chosen].astype(int).tolist())
print("change %s pixels, %d are allowed" % (counts, Scene.ALLOWED_PIXELS))
assert min(counts) > Scene.ALLOWED_PIXELS
