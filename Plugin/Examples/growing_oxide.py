# SPDX-License-Identifier: BSD-3-Clause
"""An oxide that grows on silicon beside a mask, as the frames of an animation.

    pvpython growing_oxide.py [FOLDER [FRAMES]]

The Python package conforming_delaunay has to be in PYTHONPATH. A wafer with a thin pad oxide is
oxidized where no nitride mask covers it (LOCOS). Oxide takes 0.44 of its thickness from the silicon
and rises by the other 0.56; under the edge of the mask it tapers off in a bird's beak. In each time
step the interface and the surface are moved by vtkMovingBoundaryRemesher, and the mesh stays
Delaunay and conforming; vtkSteinerPointRefiner splits the few edges with a negative coupling of the
box method. Writes FOLDER/growing_oxide_0000.png and so on (24 frames by default), the
last mesh FOLDER/growing_oxide.vtu (inline binary), and prints the counts. A film of the frames:

    ffmpeg -framerate 8 -i growing_oxide_%04d.png -pix_fmt yuv420p growing_oxide.mp4
"""

import math
import os
import sys

import numpy
from conforming_delaunay import (
    vtkBoundaryTriangulator, vtkConformingDelaunayMesher, vtkDelaunayMeshCriteria,
    vtkMeshPointGenerator, vtkMovingBoundaryRemesher, vtkSteinerPointRefiner)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_INT, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

SILICON, OXIDE = 0, 1
# Micrometres. The mask covers x < 0; the wafer's surface is z = 0.
LENGTH, WIDTH, DEPTH = 0.6, 0.4, 0.6
PAD, GROWN = 0.02, 0.4  # thickness of the oxide before, and away from the mask after it
BEAK = 0.12  # length over which the oxide tapers off
SPACING = 0.05
TOP, BOTTOM = 0.56, 0.44  # parts of the grown thickness above and below the old interface


def MakeWafer():
    """Silicon and pad oxide as polygons: each side of the two boxes, their interface once."""
    levels = (-DEPTH, 0.0, PAD)
    points = [(x, y, z) for z in levels
              for x, y in ((-LENGTH, 0.0), (LENGTH, 0.0), (LENGTH, WIDTH), (-LENGTH, WIDTH))]
    polygons = [((3, 2, 1, 0), (-1, SILICON)), ((4, 5, 6, 7), (OXIDE, SILICON)),
                ((8, 9, 10, 11), (-1, OXIDE))]
    for region in (SILICON, OXIDE):
        for i in range(4):
            j, first = (i + 1) % 4, 4 * region
            polygons.append(((first + i, first + j, first + 4 + j, first + 4 + i), (-1, region)))
    wafer = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(numpy.array(points), deep=True))
    wafer.SetPoints(coordinates)
    cells = vtkCellArray()
    for ids, _ in polygons:
        cells.InsertNextCell(len(ids), ids)
    wafer.SetPolys(cells)
    labels = numpy_to_vtk(numpy.array([pair for _, pair in polygons]), deep=True,
                          array_type=VTK_INT)
    labels.SetName("BoundaryLabels")
    wafer.GetCellData().AddArray(labels)
    return wafer


def MakeMesh():
    """The wafer before: tetrahedra and their boundary, with layers on both sides of the interface."""
    wafer = MakeWafer()
    surface = vtkBoundaryTriangulator()
    surface.SetInputData(wafer)
    points = vtkMeshPointGenerator()
    points.SetInputConnection(surface.GetOutputPort())
    points.SetSpacing(SPACING, SPACING, SPACING)
    points.AddLayers(OXIDE, SILICON, 3, 0.25 * PAD, 1.0)
    points.AddLayers(SILICON, OXIDE, 4, 0.25 * SPACING, 1.5)
    mesher = vtkConformingDelaunayMesher()
    mesher.SetMeshForToFewestPoints()
    mesher.SetInputData(wafer)
    mesher.SetInputConnection(1, points.GetOutputPort())
    mesher.SetCriterionToSmallestSphereAndEdges()
    mesher.SetMaximumEdgeLength(SPACING)
    mesher.Update()
    return mesher.GetOutputDataObject(0), mesher.GetOutputDataObject(1)


def GetThickness(x, time):
    """Of the oxide grown at x until a time from 0 to 1: by the square root law, less under the mask."""
    profile = 0.5 * numpy.array([math.erfc(-2.0 * place / BEAK) for place in x])
    return (GROWN - PAD) * math.sqrt(time) * profile


def SetDisplacement(mesh, boundary, begin, end):
    """Gives the points of the interface and of the oxide's surface the growth between two times."""
    places = vtk_to_numpy(mesh.GetPoints().GetData())
    ids = {tuple(place): i for i, place in enumerate(places)}
    corners = vtk_to_numpy(boundary.GetPoints().GetData())
    triangles = vtk_to_numpy(boundary.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    labels = vtk_to_numpy(boundary.GetCellData().GetArray("BoundaryLabels"))
    a, b, c = (corners[triangles[:, i]] for i in range(3))
    normals = numpy.cross(b - a, c - a)
    share = numpy.zeros(len(places))
    isInterface = labels.min(axis=1) == SILICON
    isTop = ~isInterface & (labels.max(axis=1) == OXIDE) & (
        numpy.abs(normals[:, 2]) > 1e-6 * numpy.linalg.norm(normals, axis=1))
    for chosen, part in ((isTop, TOP), (isInterface, -BOTTOM)):
        for corner in numpy.unique(triangles[chosen]):
            share[ids[tuple(corners[corner])]] = part
    growth = GetThickness(places[:, 0], end) - GetThickness(places[:, 0], begin)
    displacement = numpy_to_vtk(
        numpy.outer(share * growth, (0.0, 0.0, 1.0)), deep=True)
    displacement.SetName("Displacement")
    mesh.GetPointData().SetVectors(displacement)


def Move(mesh, boundary, begin, end):
    """Moves the boundary through one time step: the remesher that has done it."""
    moving = vtkUnstructuredGrid()
    moving.ShallowCopy(mesh)
    SetDisplacement(moving, boundary, begin, end)
    remesher = vtkMovingBoundaryRemesher()
    remesher.SetInputData(moving)
    remesher.SetCriterionToSmallestSphereAndEdges()
    # The tapering surface is smooth: its triangles may be flipped.
    remesher.SetAccuracyAngle(30.0)
    remesher.SetMaximumEdgeLength(1.5 * SPACING)
    remesher.Update()
    return remesher


def Grow(mesh, boundary, begin, end):
    """One time step: the new tetrahedra, their boundary, numbers of points removed and new ones."""
    remesher = Move(mesh, boundary, begin, end)
    # Couplings only: no shape is asked for.
    refiner = vtkSteinerPointRefiner()
    refiner.SetInputConnection(remesher.GetOutputPort())
    refiner.SetCriterionToSmallestSphereAndEdges()
    refiner.SetAccuracyAngle(30.0)
    refiner.SetRadiusEdgeRatio(0.0)
    refiner.SetDihedralAngleTarget(0.0)
    refiner.Update()
    return (refiner.GetOutputDataObject(0), refiner.GetOutputDataObject(1),
            remesher.GetNumberOfRemovedPoints(),
            remesher.GetNumberOfNewPoints() + refiner.GetNumberOfBoundaryPoints())


def CountFaults(mesh, boundary):
    """What a mesh may be at fault with, by name."""
    criteria = vtkDelaunayMeshCriteria()
    criteria.SetInputData(0, mesh)
    criteria.SetInputData(1, boundary)
    criteria.Update()
    fields = criteria.GetOutput().GetFieldData()
    return {name: int(fields.GetArray(name).GetValue(0))
            for name in ("InvertedTetrahedra", "FlatTetrahedra", "NonDelaunayTetrahedra",
                         "FacetSphereViolations", "NegativeCouplings")}


def Draw(mesh, path):
    """A picture of the mesh, cut open along its length."""
    from paraview.simple import (
        Clip, ColorBy, CreateView, Delete, GetColorTransferFunction, SaveScreenshot, Show,
        TrivialProducer, _DisableFirstRenderCameraReset)

    _DisableFirstRenderCameraReset()
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(mesh)
    producer.UpdatePipeline()
    view = CreateView("RenderView")
    view.ViewSize = [1000, 700]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0.965, 0.972, 0.980]
    view.CameraParallelProjection = 1
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraFocalPoint = [0.0, 0.5 * WIDTH, -0.15]
    view.CameraPosition = [-1.2, -4.0, 2.0]
    view.CameraParallelScale = 0.52
    cut = Clip(Input=producer, ClipType="Plane", Crinkleclip=1, Invert=0)
    cut.ClipType.Origin = [0.0, 0.4 * WIDTH, 0.0]
    cut.ClipType.Normal = [0.0, 1.0, 0.0]
    display = Show(cut, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.13, 0.16, 0.21]
    display.Ambient = 0.35
    ColorBy(display, ("CELLS", "RegionId"))
    colours = GetColorTransferFunction("RegionId")
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = ["0", "Silicon", "1", "Oxide"]
    colours.IndexedColors = [0.49, 0.65, 0.84, 0.96, 0.74, 0.24]
    SaveScreenshot(path, view, ImageResolution=[1000, 700])
    for proxy in (cut, producer, view):
        Delete(proxy)


def Main(folder, frames):
    """Grows the oxide; True if all meshes were valid, Delaunay, and fit for the box method."""
    from paraview.simple import SaveData, TrivialProducer

    os.makedirs(folder, exist_ok=True)
    mesh, boundary = MakeMesh()
    isGood = True
    print("frame  oxide (um)  points  removed  new  tetrahedra  faults")
    for frame in range(frames):
        removed = new = 0
        time = frame / max(1, frames - 1)
        if frame > 0:
            mesh, boundary, removed, new = Grow(
                mesh, boundary, (frame - 1) / (frames - 1), time)
        faults = CountFaults(mesh, boundary)
        isGood = isGood and not any(faults.values())
        print("%5d  %10.3f  %6d  %7d  %3d  %10d  %s" % (
            frame, PAD + GetThickness([LENGTH], time)[0], mesh.GetNumberOfPoints(), removed, new,
            mesh.GetNumberOfCells(),
            ", ".join("%s %d" % item for item in faults.items() if item[1] > 0) or "none"))
        Draw(mesh, os.path.join(folder, "growing_oxide_%04d.png" % frame))
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(mesh)
    # Not appended, ParaView's default: Debian's ParaView 5.11 cannot read its own appended files.
    SaveData(os.path.join(folder, "growing_oxide.vtu"), proxy=producer, DataMode="Binary")
    return isGood


if __name__ == "__main__":
    sys.exit(0 if Main(sys.argv[1] if len(sys.argv) > 1 else ".",
                       int(sys.argv[2]) if len(sys.argv) > 2 else 24) else 1)
