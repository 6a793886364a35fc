# SPDX-License-Identifier: BSD-3-Clause
"""Stage 1: the structural edges of the sample devices as tubes, coloured by kind.

Red: more than two triangles; blue: sharp. Behind them the far walls.
"""

import numpy

import Scene
from conforming_delaunay import vtkBoundaryTriangulator, vtkStructuralEdgeExtractor

COLOURS = ((0.20, 0.62, 0.40), (0.80, 0.22, 0.22), (0.94, 0.68, 0.18), (0.20, 0.38, 0.68))


def Extract(device):
    """The surface and its structural edges."""
    triangulator = vtkBoundaryTriangulator()
    triangulator.SetInputConnection(device.GetOutputPort())
    extractor = vtkStructuralEdgeExtractor()
    extractor.SetInputConnection(triangulator.GetOutputPort())
    extractor.Update()
    return extractor.GetOutput(0), extractor.GetOutput(1)


def CountByKind(edges):
    """Number of edges of each of the four kinds."""
    return numpy.bincount(Scene.GetCellArray(edges, "Kind"), minlength=4).tolist()


def Draw(scene, surface, edges, radius, name):
    labels = Scene.GetCellArray(surface, "BoundaryLabels")
    walls = [ids for ids, front in zip(Scene.GetPolygons(surface), labels[:, 0]) if front == -1]
    scene.AddFarSide(Scene.MakeSurface(Scene.GetPoints(surface), walls), Scene.GREY)
    kinds = Scene.GetCellArray(edges, "Kind")
    ends = Scene.GetLines(edges)
    for kind, colour in enumerate(COLOURS):
        if (kinds == kind).any():
            part = Scene.MakeLines(Scene.GetPoints(edges), ends[kinds == kind])
            scene.AddTubes(part, colour, radius)
    scene.Save(name)


surface, edges = Extract(Scene.MakeMosTransistor())
# The cross-section has 16 corners and 20 lines: 16 edges along y, and 20 in each end face. More
# than two triangles meet at the 8 corners that are ends of interfaces, and at the 6 interfaces in
# each end face: 8 + 2 * 6.
assert CountByKind(edges) == [0, 20, 0, 36], CountByKind(edges)
angles = Scene.GetCellArray(edges, "DihedralAngle")
assert ((angles >= 0.0) & (angles <= 180.0)).all()
Draw(Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0), surface, edges, 0.005,
     "StructuralEdgeExtractor.png")

surface, edges = Extract(Scene.MakeViaPlug())
# More than two triangles: 24 edges around each end of the plug; of each line 3 edges at both ends
# and 2 along the face of the box. Sharp: 24 along the plug; 12 of the box, 4 of them in three
# pieces; of each line 2 more, in two pieces.
assert CountByKind(edges) == [0, 64, 0, 52], CountByKind(edges)
Draw(Scene.Scene((0.0, 0.0, 0.3), (0.55, -1.0, 0.45), 1.75), surface, edges, 0.008,
     "StructuralEdgeExtractorVia.png")

Scene.AssertSameAsBaselines(
    "StructuralEdgeExtractor.png", "StructuralEdgeExtractorVia.png")
