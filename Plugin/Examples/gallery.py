# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts of the gallery share: devices, meshes, tables beside the thesis, pictures.

The scripts are locos.py, layout_interconnect.py, dram_interconnect.py, two_layer_interconnect.py,
vapor_deposition.py, nmos_transistor.py and cmos_inverter.py: the devices of P. Fleischmann's thesis
(TU Wien 1999); and solid_models.py, for its models of a hand, a bust, a cow and a skull. Each runs as

    pvpython SCRIPT [FOLDER]

(solid_models.py with a model before the folder) with the Python package conforming_delaunay in PYTHONPATH, writes its meshes as FOLDER/*.vtu (inline
binary) and its pictures as FOLDER/*.png, and ends with an error if a mesh is not what it should be.
"""

import os
import sys

import numpy
from conforming_delaunay import (
    get_texts,
    vtkConformingDelaunayMesher, vtkDelaunayMeshCriteria, vtkTechnologyStructureSource)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkExtractCells

TARGET = 15.0  # degrees: smaller dihedral angles only where they are inevitable
INEVITABLE = 4  # value of RefinementFault: in thin layers and at sharp angles of the device
FAULTS = ("InvertedTetrahedra", "FlatTetrahedra", "NonDelaunayTetrahedra", "FacetSphereViolations",
          "EdgeSphereViolations", "OpenControlVolumes", "NegativeCouplings")

SILICON = (0.49, 0.69, 0.44)
OXIDE = (0.68, 0.74, 0.80)
NITRIDE = (0.82, 0.34, 0.32)
POLYSILICON = (0.36, 0.54, 0.80)
ALUMINIUM = (0.88, 0.71, 0.34)
TUNGSTEN = (0.62, 0.62, 0.66)
GAS = (0.66, 0.80, 0.92)
LINES = [0.13, 0.16, 0.21]


def MakeDevice(structure, **parameters):
    """The source of a device, by the name of its SetStructureTo method, with parameters."""
    device = vtkTechnologyStructureSource()
    getattr(device, "SetStructureTo" + structure)()
    for name, value in parameters.items():
        getattr(device, "Set" + name)(value)
    device.Update()
    return device


def MakeSizing(device, length, side=41):
    """The lengths of edges, as a function of arrays x, y and z, on a grid over the device."""
    low, high = (numpy.array(device.GetOutput().GetBounds()[i::2]) for i in range(2))
    image = vtkImageData()
    image.SetDimensions(side, side, side)
    image.SetOrigin(*low)
    image.SetSpacing(*((high - low) / (side - 1)))
    z, y, x = (numpy.linspace(low[i], high[i], side) for i in (2, 1, 0))
    z, y, x = numpy.meshgrid(z, y, x, indexing="ij")
    sizing = numpy_to_vtk(length(x, y, z).ravel(), deep=True)
    sizing.SetName("Sizing")
    image.GetPointData().AddArray(sizing)
    return image


def MakeMesh(device, length=0.0, sizing=None, points=None):
    """The tetrahedra with the arrays of the certificate.

    Closed control volumes, no slivers, edges up to a length in micrometres (0: any) or as a sizing
    asks for; mesh points, however close to the boundary, stay where they are.
    """
    mesher = vtkConformingDelaunayMesher()
    mesher.SetMeshForToFewestPoints()
    mesher.SetInputConnection(device.GetOutputPort())
    mesher.SetInputData(1, points)
    mesher.SetInputData(2, sizing)
    mesher.SetMeshPointClearanceRatio(0.0)
    mesher.SetCriterionToSmallestSphereAndEdges()
    mesher.SetMaximumEdgeLength(length)
    mesher.AddSteinerPointsOn()
    mesher.SetRadiusEdgeRatio(2.0)
    mesher.SetDihedralAngleTarget(TARGET)
    mesher.Update()
    return Certify(mesher.GetOutputDataObject(0), mesher.GetOutputDataObject(1))


def Certify(mesh, boundary):
    """The tetrahedra with the arrays of the certificate."""
    criteria = vtkDelaunayMeshCriteria()
    criteria.SetInputData(0, mesh)
    criteria.SetInputData(1, boundary)
    criteria.Update()
    return criteria.GetOutput()


def GetCells(mesh, name):
    """A cell array as numbers."""
    return vtk_to_numpy(mesh.GetCellData().GetArray(name))


def GetCentroids(mesh):
    """Three columns."""
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    ids = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return points[ids].mean(axis=1)


def Report(title, mesh, thesis):
    """Print tetrahedra beside those of the thesis; what is wrong with the mesh, a list of words.

    thesis: pairs of region names (those that begin with a word of a tuple, or None: all) and a
    count (None: none given).
    """
    names = get_texts(mesh, "RegionNames")
    counts = numpy.bincount(GetCells(mesh, "RegionId"), minlength=len(names))
    wrong = []
    print("%-44s %12s %12s" % (title, "tetrahedra", "thesis"))
    for words, limit in thesis:
        count = sum(number for name, number in zip(names, counts)
                    if words is None or name.startswith(words))
        text = "all" if words is None else ", ".join(words)
        print("  %-42s %12d %12s" % (text, count, "-" if limit is None else limit))
        if limit is not None and count > limit:
            wrong.append("%d tetrahedra in %s" % (count, text))
    summary = mesh.GetFieldData()
    for name in FAULTS:
        number = int(summary.GetArray(name).GetValue(0))
        if number:
            wrong.append("%d %s" % (number, name))
    angles = GetCells(mesh, "SmallestDihedralAngle")
    # The array is there only if there is something to say.
    hasFaults = mesh.GetCellData().HasArray("RefinementFault")
    inevitable = (GetCells(mesh, "RefinementFault") == INEVITABLE if hasFaults
                  else numpy.zeros(len(angles), dtype=bool))
    print("  smallest dihedral angle %.1f degrees; in thin layers and at sharp angles %.2f (%d "
          "tetrahedra)" % (angles[~inevitable].min(), angles.min(), inevitable.sum()))
    if angles[~inevitable].min() < TARGET:
        wrong.append("%d slivers" % (angles[~inevitable] < TARGET).sum())
    print("  certificate:", "\n    ".join(get_texts(mesh, "Certificate")))
    if wrong:
        print("  wrong:", "; ".join(wrong))
    return wrong


def Compare(title, mesh, faults, limit=None):
    """As Report(), for a mesh without Steiner points: shapes of tetrahedra do not count."""
    number = mesh.GetNumberOfCells()
    summary = mesh.GetFieldData()
    print("%-44s %12s %12s" % (title, "tetrahedra", "thesis"))
    print("  %-42s %12d %12s" % ("all", number, "-" if limit is None else limit))
    print("  certificate:", "\n    ".join(get_texts(mesh, "Certificate")))
    wrong = ["%d %s" % (summary.GetArray(name).GetValue(0), name) for name in faults
             if summary.GetArray(name).GetValue(0)]
    if limit is not None and number > limit:
        wrong.append("%d tetrahedra" % number)
    if wrong:
        print("  wrong:", "; ".join(wrong))
    return wrong


def Extract(mesh, keep):
    """The cells for which keep is true."""
    ids = vtkIdList()
    for cell in numpy.flatnonzero(keep):
        ids.InsertNextId(int(cell))
    extractor = vtkExtractCells()
    extractor.SetInputData(mesh)
    extractor.SetCellList(ids)
    extractor.Update()
    return extractor.GetOutput()


def Save(data, path):
    """A data set as a file of VTK."""
    from paraview.simple import Delete, SaveData, TrivialProducer

    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    producer.UpdatePipeline()
    # Not appended, ParaView's default: Debian's ParaView 5.11 cannot read its own appended files.
    SaveData(path, proxy=producer, DataMode="Binary")
    Delete(producer)
    print("wrote", path)


def Draw(path, parts, direction, height):
    """A picture, seen from a direction; height: of what is seen, in micrometres.

    parts: data sets that are drawn as surfaces, each with its colours, and whether with edges.
    Colours: those of the regions by id; or a point array and its range, (name, low, high); or
    None: only the outlines of the cells are drawn.
    """
    from paraview.simple import (
        ColorBy, CreateView, Delete, GetColorTransferFunction, SaveScreenshot, Show,
        TrivialProducer, _DisableFirstRenderCameraReset)

    _DisableFirstRenderCameraReset()
    view = CreateView("RenderView")
    view.ViewSize = [900, 700]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0.965, 0.972, 0.980]
    shown = []
    for i, (data, colours, edges) in enumerate(parts):
        producer = TrivialProducer(registrationName="part%d" % i)
        producer.GetClientSideObject().SetOutput(data)
        producer.UpdatePipeline()
        display = Show(producer, view)
        display.Representation = "Surface With Edges" if edges else "Surface"
        display.EdgeColor = LINES
        display.Ambient = 0.25
        if colours is None:
            display.Representation = "Wireframe"
            display.ColorArrayName = ["CELLS", ""]
            display.AmbientColor = display.DiffuseColor = LINES
            display.LineWidth = 2.0
        elif isinstance(colours[0], str):
            name, low, high = colours
            ColorBy(display, ("POINTS", name))
            GetColorTransferFunction(name).RescaleTransferFunction(low, high)
            display.SetScalarBarVisibility(view, False)
        else:
            ColorBy(display, ("CELLS", "RegionId"), separate=True)
            table = GetColorTransferFunction("RegionId", display, separate=True)
            table.InterpretValuesAsCategories = 1
            table.Annotations = [text for j in range(len(colours)) for text in (str(j), str(j))]
            table.IndexedColors = [channel for entry in colours for channel in entry]
            display.SetScalarBarVisibility(view, False)
        shown.append(producer)
    bounds = [data.GetBounds() for data, _, _ in parts]
    centre = [0.5 * (min(box[2 * i] for box in bounds) + max(box[2 * i + 1] for box in bounds))
              for i in range(3)]
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = centre
    view.CameraPosition = [c + 10.0 * height * d for c, d in zip(centre, direction)]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelScale = 0.5 * height
    SaveScreenshot(path, view, ImageResolution=[900, 700])
    print("wrote", path)
    for proxy in (*shown, view):
        Delete(proxy)


def Main(run, *words):
    """Call run(folder), which returns what is wrong, and end the program accordingly.

    words: what has to come before the folder in the command, and is given to run before it.
    """
    if len(sys.argv) <= len(words):
        sys.exit("%s %s [FOLDER]" % (os.path.basename(sys.argv[0]), " ".join(words)))
    values, rest = sys.argv[1:1 + len(words)], sys.argv[1 + len(words):]
    folder = rest[0] if rest else "."
    os.makedirs(folder, exist_ok=True)
    sys.exit(1 if run(*values, folder) else 0)
