# SPDX-License-Identifier: BSD-3-Clause
"""From the polygons of a MOS transistor to tetrahedra, numbers, a file and a picture.

    pvpython mos_transistor.py [FOLDER]

The Python package conforming_delaunay has to be in PYTHONPATH. Writes FOLDER/mos_transistor.vtu
(inline binary) and FOLDER/mos_transistor.png: the mesh cut open, coloured by region.
"""

import os
import sys

from conforming_delaunay import get_texts, vtkConformingDelaunayMesher, vtkTechnologyStructureSource
from paraview.simple import *
from paraview.simple import _DisableFirstRenderCameraReset
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

COLOURS = [0.36, 0.54, 0.75,  0.93, 0.80, 0.27,  0.80, 0.33, 0.28,
           0.55, 0.74, 0.47,  0.66, 0.53, 0.78]


def MakeMesh():
    """The tetrahedra, with nothing asked for but the device, and the names of the regions."""
    device = vtkTechnologyStructureSource()
    mesher = vtkConformingDelaunayMesher()
    mesher.SetInputConnection(device.GetOutputPort())
    mesher.Update()
    names = get_texts(device.GetOutput(), "RegionNames")
    print("%d polygons in" % device.GetOutput().GetNumberOfCells())
    return mesher.GetOutputDataObject(0), names


def Report(mesh, names):
    """Print the regions and the verdict; False if the mesh is at fault."""
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(mesh)
    sizes.Update()
    data = dataset_adapter.WrapDataObject(sizes.GetOutput()).CellData
    print("%-14s %12s %20s" % ("region", "tetrahedra", "volume (um^3)"))
    for region, name in enumerate(names):
        inside = data["RegionId"] == region
        print("%-14s %12d %20.12g" % (name, inside.sum(), data["Volume"][inside].sum()))
    certificate = get_texts(mesh, "Certificate")
    print("verdict:", "\n".join(certificate))
    return certificate[0] == "CLEAN FOR FINITE VOLUMES"


def WriteAndDraw(mesh, names, folder):
    """Save the mesh, and a picture of it that is cut open in the middle of the device."""
    producer = TrivialProducer(registrationName="mesh")
    producer.GetClientSideObject().SetOutput(mesh)
    producer.UpdatePipeline()
    path = os.path.join(folder, "mos_transistor.vtu")
    # Not appended, ParaView's default: Debian's ParaView 5.11 cannot read its own appended files.
    SaveData(path, proxy=producer, DataMode="Binary")
    print("wrote", path)

    _DisableFirstRenderCameraReset()
    view = CreateView("RenderView")
    view.ViewSize = [1200, 900]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    low, high = mesh.GetBounds()[2:4]
    cut = Clip(Input=producer, ClipType="Plane", Crinkleclip=1, Invert=0)
    cut.ClipType.Origin = [0.0, low + 0.5 * (high - low), 0.0]
    cut.ClipType.Normal = [0.0, 1.0, 0.0]
    display = Show(cut, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.1, 0.1, 0.1]
    display.Ambient = 0.25
    ColorBy(display, ("CELLS", "RegionId"))
    colours = GetColorTransferFunction("RegionId")
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [text for i, name in enumerate(names) for text in (str(i), name)]
    colours.IndexedColors = COLOURS[:3 * len(names)]
    bar = GetScalarBar(colours, view)
    bar.Title = "Region"
    bar.ComponentTitle = ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    display.SetScalarBarVisibility(view, True)
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraPosition = [0.5, -2.0, 0.8]
    view.CameraFocalPoint = [0.0, 0.0, 0.0]
    view.ResetCamera(True)
    path = os.path.join(folder, "mos_transistor.png")
    SaveScreenshot(path, view, ImageResolution=[1200, 900])
    print("wrote", path)
    Delete(view)


output = sys.argv[1] if len(sys.argv) > 1 else "."
os.makedirs(output, exist_ok=True)
tetrahedra, regions = MakeMesh()
valid = Report(tetrahedra, regions)
WriteAndDraw(tetrahedra, regions, output)
sys.exit(0 if valid else 1)
