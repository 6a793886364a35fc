# SPDX-License-Identifier: BSD-3-Clause
"""The NMOS transistor: 5 nm of gate oxide on a channel of 0.18 um between two field oxides.

    pvpython nmos_transistor.py [FOLDER]

Structural edges, structure, and the mesh with a boron implantation profile of section 7.4 (Fig.
7.21 to 7.23). Layers of mesh points resolve the gate oxide and the inversion layer below it. See
gallery.py.
"""

import os

import gallery
import numpy
from conforming_delaunay import (
    vtkBoundaryTriangulator, vtkMeshPointGenerator, vtkStructuralEdgeExtractor)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

THESIS = ((None, 134374),)
COLOURS = ((gallery.SILICON,) + 2 * (gallery.OXIDE,) + ((0.96, 0.74, 0.24), gallery.POLYSILICON)
           + ((0.80, 0.86, 0.92),))
BULK, GATE_OXIDE, COVER = 0, 3, 5
WIDTH, CHANNEL, OXIDE = 0.6, 0.18, 0.005
# The implantation: decades of the largest concentration, its depth and straggle in micrometres.
PEAK, DEPTH, STRAGGLE = 18.0, 0.08, 0.05
DIRECTION = (-0.7, -1.0, 0.75)


def GetLength(x, y, z):
    """Finest in the channel."""
    outside = [numpy.maximum(abs(place) - 0.5 * CHANNEL, 0.0) for place in (x, y - 0.5 * WIDTH)]
    return numpy.minimum(0.1, 0.02 + 0.3 * numpy.sqrt(outside[0]**2 + outside[1]**2 + z**2))


def MakeLayers(device, sizing):
    """Points in the middle of the gate oxide, and in five layers below it."""
    surface = vtkBoundaryTriangulator()
    surface.SetInputConnection(device.GetOutputPort())
    layers = vtkMeshPointGenerator()
    layers.SetInputConnection(surface.GetOutputPort())
    layers.SetInputData(1, sizing)
    layers.SetPlacementToNone()
    layers.AddLayers(GATE_OXIDE, BULK, 1, 0.5 * OXIDE, 1.0)
    layers.AddLayers(BULK, GATE_OXIDE, 5, 0.5 * OXIDE, 1.6)
    layers.Update()
    return layers.GetOutput()


def AddProfile(mesh):
    """The point array Boron: decades of its concentration, a Gaussian in depth."""
    z = vtk_to_numpy(mesh.GetPoints().GetData())[:, 2]
    boron = PEAK - 0.5 * ((z + DEPTH) / STRAGGLE)**2 / numpy.log(10.0)
    array = numpy_to_vtk(numpy.maximum(boron, 12.0), deep=True)
    array.SetName("Boron")
    mesh.GetPointData().AddArray(array)


def Run(folder):
    device = gallery.MakeDevice(
        "NmosWithFieldOxide", DeviceWidth=WIDTH, ChannelWidth=CHANNEL, GateLength=CHANNEL,
        GateOxideThickness=OXIDE, CoverOxideThickness=0.03)
    surface = vtkBoundaryTriangulator()
    surface.SetInputConnection(device.GetOutputPort())
    edges = vtkStructuralEdgeExtractor()
    edges.SetInputConnection(surface.GetOutputPort())
    edges.Update()
    gallery.Draw(os.path.join(folder, "nmos_edges.png"),
                 ((edges.GetOutputDataObject(1), None, False),), DIRECTION, 1.2)

    sizing = gallery.MakeSizing(device, GetLength)
    mesh = gallery.MakeMesh(device, sizing=sizing, points=MakeLayers(device, sizing))
    wrong = gallery.Report("NMOS transistor", mesh, THESIS)
    AddProfile(mesh)
    gallery.Save(mesh, os.path.join(folder, "nmos_transistor.vtu"))
    regions = gallery.GetCells(mesh, "RegionId")
    isBefore = gallery.GetCentroids(mesh)[:, 1] < 0.5 * WIDTH
    bare = gallery.Extract(mesh, regions != COVER)
    gallery.Draw(os.path.join(folder, "nmos_transistor.png"), ((bare, COLOURS, True),), DIRECTION,
                 1.2)
    gallery.Draw(os.path.join(folder, "nmos_profile.png"),
                 ((gallery.Extract(mesh, ~isBefore & (regions != BULK)), COLOURS, True),
                  (gallery.Extract(mesh, ~isBefore & (regions == BULK)),
                   ("Boron", 14.0, PEAK), True)), DIRECTION, 1.2)
    return wrong


gallery.Main(Run)
