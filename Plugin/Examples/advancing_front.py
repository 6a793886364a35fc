# SPDX-License-Identifier: BSD-3-Clause
"""The advancing front on its way through a MOS transistor, as the frames of an animation.

    pvpython advancing_front.py [FOLDER [FRAMES]]

The Python package conforming_delaunay has to be in PYTHONPATH. Writes
FOLDER/advancing_front_0000.png and so on (48 frames by default): tetrahedra by region, and the
front in orange. It stops after a number of tetrahedra that grows from frame to frame; what is
meshed never changes. A film of them:

    ffmpeg -framerate 12 -i advancing_front_%04d.png -pix_fmt yuv420p advancing_front.mp4
"""

import os
import sys

import numpy
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner,
    vtkTechnologyStructureSource)
from paraview.simple import *
from paraview.simple import _DisableFirstRenderCameraReset
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

# Bulk, GateOxide, Gate, LeftSpacer, RightSpacer.
COLOURS = [0.49, 0.65, 0.84,  0.96, 0.74, 0.24,  0.82, 0.34, 0.32,
           0.55, 0.75, 0.48,  0.35, 0.66, 0.58]
LINES = [0.13, 0.16, 0.21]
ORANGE = [0.96, 0.58, 0.20]


def MakeMeshPoints(spacing):
    """A body-centred lattice of points in bulk and gate, for tetrahedra of good shape."""
    points = []
    for low, high in (((-0.4, 0.0, -0.5), (0.4, 0.3, 0.0)),
                      ((-0.09, 0.0, 0.005), (0.09, 0.3, 0.205))):
        low, high = numpy.array(low), numpy.array(high)
        counts = numpy.rint((high - low) / spacing).astype(int)
        for shift in (0.5, 1.0):
            places = numpy.indices(counts).reshape(3, -1).T + shift
            inside = (places < counts - 0.25).all(axis=1)
            points.append(low + (high - low) / counts * places[inside])
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(numpy.concatenate(points), deep=True))
    data = vtkPolyData()
    data.SetPoints(coordinates)
    return data


def MakePipeline():
    """The refined surface, and the filter whose front is watched."""
    device = vtkTechnologyStructureSource()
    triangulator = vtkBoundaryTriangulator()
    triangulator.SetInputConnection(device.GetOutputPort())
    refiner = vtkDelaunaySurfaceRefiner()
    refiner.SetInputConnection(triangulator.GetOutputPort())
    refiner.SetInputData(1, MakeMeshPoints(0.06))
    refiner.SetMaximumEdgeLength(0.06)
    tetrahedralizer = vtkAdvancingFrontTetrahedralizer()
    tetrahedralizer.SetInputConnection(0, refiner.GetOutputPort(0))
    tetrahedralizer.SetInputConnection(1, refiner.GetOutputPort(2))
    tetrahedralizer.Update()
    return refiner, tetrahedralizer


def Show3D(view, data, colour):
    """A producer of the data and its display, a surface with edges."""
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    producer.UpdatePipeline()
    display = Show(producer, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = LINES
    display.AmbientColor = display.DiffuseColor = colour
    display.Ambient = 0.35
    return producer, display


def MakeView():
    """An empty view of the device."""
    _DisableFirstRenderCameraReset()
    view = CreateView("RenderView")
    view.ViewSize = [1000, 800]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0.965, 0.972, 0.980]
    view.CameraParallelProjection = 1
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraFocalPoint = [0.0, 0.15, -0.15]
    view.CameraPosition = [3.6, -7.85, 3.85]
    view.CameraParallelScale = 0.5
    return view


folder = sys.argv[1] if len(sys.argv) > 1 else "."
frames = int(sys.argv[2]) if len(sys.argv) > 2 else 48
os.makedirs(folder, exist_ok=True)
refiner, tetrahedralizer = MakePipeline()
total = tetrahedralizer.GetOutput(0).GetNumberOfCells()

view = MakeView()
edges, display = Show3D(view, refiner.GetOutput(1), LINES)
display.Representation = "Surface"
display.LineWidth = 2.0
display.RenderLinesAsTubes = 1
colours = GetColorTransferFunction("RegionId")
colours.InterpretValuesAsCategories = 1
colours.Annotations = [text for i in range(5) for text in (str(i), str(i))]
colours.IndexedColors = COLOURS

for frame in range(frames):
    tetrahedralizer.SetMaximumNumberOfTetrahedra(total * (frame + 1) // frames)
    tetrahedralizer.Update()
    mesh, display = Show3D(view, tetrahedralizer.GetOutputDataObject(0), COLOURS[:3])
    ColorBy(display, ("CELLS", "RegionId"))
    shown = [mesh]
    front = tetrahedralizer.GetOutputDataObject(2)
    if front.GetNumberOfCells() > 0:
        producer, display = Show3D(view, front, ORANGE)
        # A little towards the camera: it lies on faces of the tetrahedra.
        # ParaView 5.11 has another name for that.
        name = "Translation" if "Translation" in display.ListProperties() else "Position"
        setattr(display, name, [0.00045, -0.001, 0.0005])
        shown.append(producer)
    path = os.path.join(folder, "advancing_front_%04d.png" % frame)
    SaveScreenshot(path, view, ImageResolution=[1000, 800])
    print("wrote %s: %d of %d tetrahedra, %d triangles in the front" % (
        path, tetrahedralizer.GetOutput(0).GetNumberOfCells(), total, front.GetNumberOfCells()))
    for proxy in shown:
        Delete(proxy)
Delete(view)
