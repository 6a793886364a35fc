# SPDX-License-Identifier: BSD-3-Clause
"""Solids of many small polygons: a hand, a bust, a cow, a skull.

    pvpython solid_models.py KIND MODEL [FOLDER]

KIND is hand, bust, cow or skull, the models of Fig. 7.1 to 7.9; MODEL is a file of such a surface
that ParaView reads (.vtp, .stl, .obj, .ply), upright in y. The thesis's own models are not to be had:
those with far more triangles are reduced first, until there are about as many tetrahedra. Writes KIND.vtu, tetrahedra that
are Delaunay as the thesis's are; KIND_boxes.vtu, in which all control volumes are closed, too, for more
points; KIND_edges.png, the structural edges, which form a contour plot (7.3); and

    hand    hand_front.png, the advancing front at four moments (7.1); hand_mesh.png, edges and points
            as tubes and spheres (7.6)
    bust, cow    KIND_mesh.png, tetrahedra that are shrunk (7.5, 7.7)
    skull   skull_mesh.png, the surface (7.8); skull_sections.png, three cross-sections (7.9)

See gallery.py.
"""

import os
import sys

import gallery
import numpy
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner,
    vtkStructuralEdgeExtractor)
from paraview.simple import Delete, OpenDataFile
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import (
    vtkCleanPolyData, vtkCutter, vtkExtractEdges, vtkGlyph3D, vtkQuadricDecimation,
    vtkTriangleFilter, vtkTubeFilter)
from vtkmodules.vtkFiltersGeneral import vtkShrinkFilter, vtkTransformFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

SKIN = (0.93, 0.76, 0.66)
BONE = (0.90, 0.87, 0.78)
HIDE = (0.80, 0.66, 0.52)
MARBLE = (0.86, 0.86, 0.88)
FRONT = (0.96, 0.58, 0.20)
# Colour, tetrahedra of the thesis, triangles to which a finer model is reduced.
KINDS = {"hand": (SKIN, 4344, 1400), "bust": (MARBLE, 17665, 6000), "cow": (HIDE, 11608, 6000),
         "skull": (BONE, 28512, 12000)}
ACCURACY = 5.0  # degrees
CONTOURS = 20.0  # degrees: edges that bend more are drawn
AHEAD = (-0.35, -1.0, 0.25)  # where pictures are seen from


def Read(path, triangles):
    """The surface with z upwards, one unit long, reduced to a number of triangles if it has more."""
    reader = OpenDataFile(path)
    reader.UpdatePipeline()
    clean = vtkCleanPolyData()
    clean.SetInputData(reader.GetClientSideObject().GetOutputDataObject(0))
    clean.Update()
    Delete(reader)
    bounds = numpy.array(clean.GetOutput().GetBounds()).reshape(3, 2)
    upright = vtkTransform()
    upright.RotateX(90.0)
    upright.Scale(*(3 * [1.0 / (bounds[:, 1] - bounds[:, 0]).max()]))
    upright.Translate(*(-bounds.mean(axis=1)))
    turn = vtkTransformFilter()
    turn.SetTransform(upright)
    turn.SetInputConnection(clean.GetOutputPort())
    facets = vtkTriangleFilter()
    facets.SetInputConnection(turn.GetOutputPort())
    facets.Update()
    number = facets.GetOutput().GetNumberOfCells()
    if number <= triangles:
        return turn.GetOutput()
    reduction = vtkQuadricDecimation()
    reduction.SetInputConnection(facets.GetOutputPort())
    reduction.SetTargetReduction(1.0 - triangles / number)
    reduction.VolumePreservationOn()
    reduction.Update()
    return reduction.GetOutput()


def MakeStages(surface):
    """The filters one by one: triangulator, surface refiner, tetrahedralizer."""
    triangulator = vtkBoundaryTriangulator()
    triangulator.SetInputData(surface)
    triangulator.ResolveSelfIntersectionsOn()
    refiner = vtkDelaunaySurfaceRefiner()
    refiner.SetInputConnection(triangulator.GetOutputPort())
    refiner.SetAccuracyAngle(ACCURACY)
    front = vtkAdvancingFrontTetrahedralizer()
    front.SetInputConnection(refiner.GetOutputPort())
    front.Update()
    return triangulator, refiner, front


def Paint(data, place=(0.0, 0.0, 0.0)):
    """Data all of one region, moved to a place."""
    move = vtkTransform()
    move.Translate(*place)
    moved = vtkTransformFilter()
    moved.SetTransform(move)
    moved.SetInputData(data)
    moved.Update()
    painted = moved.GetOutput()
    region = numpy_to_vtk(numpy.zeros(painted.GetNumberOfCells(), numpy.int32), deep=True)
    region.SetName("RegionId")
    painted.GetCellData().AddArray(region)
    return painted


def DrawContours(folder, kind, surface, colour):
    """The edges at which the surface bends most, on the surface."""
    edges = vtkStructuralEdgeExtractor()
    edges.SetInputData(surface)
    edges.SetAccuracyAngle(CONTOURS)
    edges.Update()
    tubes = vtkTubeFilter()
    tubes.SetInputData(edges.GetOutput(1))
    tubes.SetRadius(0.0015)
    tubes.Update()
    gallery.Draw(os.path.join(folder, kind + "_edges.png"),
                 ((Paint(surface), (colour,), False), (Paint(tubes.GetOutput()), (gallery.LINES,), False)),
                 AHEAD, 1.15)


def DrawFront(folder, front, colour):
    """Four moments beside each other: what is meshed, and the front around it."""
    total = front.GetOutput(0).GetNumberOfCells()
    parts = []
    for i in range(4):
        front.SetMaximumNumberOfTetrahedra((2 * i + 1) * total // 8)
        front.Update()
        place = (0.9 * (i % 2), 0.0, -1.05 * (i // 2))
        parts += [(Paint(front.GetOutputDataObject(0), place), (colour,), True),
                  (Paint(front.GetOutputDataObject(2), place), (FRONT,), True)]
    front.SetMaximumNumberOfTetrahedra(0)
    front.Update()
    gallery.Draw(os.path.join(folder, "hand_front.png"), parts, (0.0, -1.0, 0.0), 2.0)


def DrawTubes(folder, mesh, colour):
    """Edges as tubes, points as spheres."""
    edges = vtkExtractEdges()
    edges.SetInputData(mesh)
    tubes = vtkTubeFilter()
    tubes.SetInputConnection(edges.GetOutputPort())
    tubes.SetRadius(0.0015)
    tubes.Update()
    points = vtkPolyData()
    points.SetPoints(mesh.GetPoints())
    spheres = vtkGlyph3D()
    spheres.SetInputData(points)
    sphere = vtkSphereSource()
    sphere.SetRadius(0.006)
    spheres.SetSourceConnection(sphere.GetOutputPort())
    spheres.Update()
    gallery.Draw(os.path.join(folder, "hand_mesh.png"),
                 ((Paint(tubes.GetOutput()), (gallery.TUNGSTEN,), False),
                  (Paint(spheres.GetOutput()), (colour,), False)), (0.0, -1.0, 0.0), 1.05)


def DrawShrunk(folder, kind, mesh, colour):
    """Each tetrahedron by itself."""
    shrink = vtkShrinkFilter()
    shrink.SetInputData(mesh)
    shrink.SetShrinkFactor(0.8)
    shrink.Update()
    gallery.Draw(os.path.join(folder, kind + "_mesh.png"),
                 ((Paint(shrink.GetOutput()), (colour,), False),), AHEAD, 1.0)


def DrawSections(folder, mesh, colour):
    """The whole; and three horizontal cuts beside each other, from above."""
    gallery.Draw(os.path.join(folder, "skull_mesh.png"), ((Paint(mesh), (colour,), True),), AHEAD, 1.15)
    low, high = mesh.GetBounds()[4:]
    parts = []
    for i, part in enumerate((0.2, 0.35, 0.5)):
        plane = vtkPlane()
        plane.SetNormal(0.0, 0.0, 1.0)
        plane.SetOrigin(0.0, 0.0, low + part * (high - low))
        cut = vtkCutter()
        cut.SetCutFunction(plane)
        cut.SetInputData(mesh)
        cut.GenerateTrianglesOff()
        cut.Update()
        parts.append((Paint(cut.GetOutput(), (0.75 * i, 0.0, 0.0)), (colour,), True))
    gallery.Draw(os.path.join(folder, "skull_sections.png"), parts, (0.0, -0.01, 1.0), 1.8)


def MakeBoxes(refiner, front):
    """The same again with closed control volumes: criterion 3.2, and every bend is a structural edge."""
    refiner.SetCriterionToSmallestSphereAndEdges()
    refiner.SetAccuracyAngle(0.0)
    # No Steiner points follow, which would mend couplings in facets whose points a file has rounded.
    refiner.SetFlatnessRatio(1e-9)
    front.Update()
    return gallery.Certify(front.GetOutputDataObject(0), front.GetOutputDataObject(1))


def Run(kind, path, folder):
    colour, thesis, triangles = KINDS[kind]
    surface = Read(path, triangles)
    triangulator, refiner, front = MakeStages(surface)
    mesh = gallery.Certify(front.GetOutputDataObject(0), front.GetOutputDataObject(1))
    wrong = gallery.Compare(kind, mesh, gallery.FAULTS[:3], thesis)
    gallery.Save(mesh, os.path.join(folder, kind + ".vtu"))
    DrawContours(folder, kind, triangulator.GetOutput(), colour)
    if kind == "hand":
        DrawFront(folder, front, colour)
        DrawTubes(folder, mesh, colour)
    elif kind == "skull":
        DrawSections(folder, mesh, colour)
    else:
        DrawShrunk(folder, kind, mesh, colour)
    boxes = MakeBoxes(refiner, front)
    wrong += gallery.Compare(kind + ", control volumes", boxes, gallery.FAULTS)
    gallery.Save(boxes, os.path.join(folder, kind + "_boxes.vtu"))
    return wrong


gallery.Main(Run, "KIND", "MODEL")
