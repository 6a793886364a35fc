# SPDX-License-Identifier: BSD-3-Clause
"""From the voxels of a topography simulation to a conforming Delaunay mesh, in one go.

    pvpython voxel_topography.py [FOLDER]

The Python package conforming_delaunay has to be in PYTHONPATH. A trench is etched into silicon, its
walls tilted and its end round, lined with oxide, filled in part with tungsten, and the tungsten is
etched back: each step changes the materials of voxels, as cellular topography simulators do.
vtkMaterialInterfaceExtractor makes smooth interfaces with few triangles of them,
vtkConformingDelaunayMesher tetrahedra. Writes FOLDER/voxel_topography.vtu (inline binary) and the
pictures voxel_topography_voxels.png and voxel_topography.png; prints the counts and the verdict of
the checker.
"""

import os
import sys

import numpy
from conforming_delaunay import get_texts, vtkConformingDelaunayMesher, vtkMaterialInterfaceExtractor
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_INT
from vtkmodules.vtkCommonDataModel import vtkImageData

GAS, SILICON, OXIDE, TUNGSTEN = -1, 0, 1, 2
NAMES = {SILICON: "silicon", OXIDE: "oxide", TUNGSTEN: "tungsten"}
# Micrometres; numbers of voxels along x, y and z.
VOXEL = 0.01
SIZE = (64, 32, 48)
SURFACE = 32  # of the wafer, in voxels
DEVIATION = 0.5  # voxels
EDGE = 0.05  # longest edge on the boundary, micrometres


def Deposit(materials, material, thickness):
    """Turns the gas within a distance, in voxels, from anything solid into a material."""
    reach = int(thickness)
    solid = numpy.pad(materials != GAS, reach, mode="edge")
    grown = numpy.zeros(materials.shape, dtype=bool)
    for shift in numpy.ndindex(*(2 * reach + 1,) * 3):
        if sum((i - reach) ** 2 for i in shift) <= thickness**2:
            grown |= solid[tuple(slice(i, i + n) for i, n in zip(shift, materials.shape))]
    materials[grown & (materials == GAS)] = material


def SimulateTopography():
    """The material of each voxel, an array with the axes z, y, x."""
    z, y, x = numpy.indices(SIZE[::-1]) + 0.5
    materials = numpy.where(z < SURFACE, SILICON, GAS)
    # A slot from the left side to a round end, narrower below.
    distance = numpy.hypot(numpy.maximum(x - 40.0, 0.0), y - 0.5 * SIZE[1])
    materials[(distance < 10.0 - 0.15 * (SURFACE - z)) & (z > 10.0)] = GAS
    Deposit(materials, OXIDE, 3.0)
    Deposit(materials, TUNGSTEN, 4.0)
    materials[(materials == TUNGSTEN) & (z > SURFACE - 2.0)] = GAS
    return materials


def MakeImage(materials):
    """The materials as cells of an image."""
    image = vtkImageData()
    image.SetDimensions(*(n + 1 for n in SIZE))
    image.SetSpacing(VOXEL, VOXEL, VOXEL)
    labels = numpy_to_vtk(materials.ravel(), deep=True, array_type=VTK_INT)
    labels.SetName("Material")
    image.GetCellData().SetScalars(labels)
    return image


def MakeMesh(image):
    """The mesh of an image, and the filter that found the interfaces."""
    interfaces = vtkMaterialInterfaceExtractor()
    interfaces.SetInputData(image)
    interfaces.SetMaximumDeviation(DEVIATION)
    mesher = vtkConformingDelaunayMesher()
    mesher.SetMeshForToFewestPoints()
    mesher.SetInputConnection(interfaces.GetOutputPort())
    mesher.SetCriterionToSmallestSphere()
    mesher.SetMaximumEdgeLength(EDGE)
    mesher.GenerateMeshPointsOn()
    mesher.Update()
    return mesher.GetOutputDataObject(0), interfaces


def GetVolumes(mesh):
    """Of each region, by its id."""
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    ids = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    a, b, c, d = (points[ids[:, i]] for i in range(4))
    volumes = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6.0
    return numpy.bincount(vtk_to_numpy(mesh.GetCellData().GetArray("RegionId")), volumes)


def Draw(data, array, path):
    """A picture of voxels or tetrahedra by material, cut open along the trench."""
    from paraview.simple import (
        Clip, ColorBy, CreateView, Delete, GetColorTransferFunction, SaveScreenshot, Show,
        Threshold, TrivialProducer, _DisableFirstRenderCameraReset)

    _DisableFirstRenderCameraReset()
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    producer.UpdatePipeline()
    solid = Threshold(Input=producer)
    solid.Scalars = ["CELLS", array]
    solid.LowerThreshold, solid.UpperThreshold = SILICON, TUNGSTEN
    cut = Clip(Input=solid, ClipType="Plane", Crinkleclip=1, Invert=0)
    middle = 0.5 * VOXEL * SIZE[1]
    cut.ClipType.Origin = [0.0, middle, 0.0]
    cut.ClipType.Normal = [0.0, 1.0, 0.0]
    view = CreateView("RenderView")
    view.ViewSize = [1000, 700]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0.965, 0.972, 0.980]
    view.CameraParallelProjection = 1
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraFocalPoint = [0.5 * VOXEL * SIZE[0], 1.5 * middle, 0.2]
    view.CameraPosition = [-0.9, -2.5, 2.0]
    view.CameraParallelScale = 0.29
    display = Show(cut, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.13, 0.16, 0.21]
    display.Ambient = 0.3
    ColorBy(display, ("CELLS", array))
    colours = GetColorTransferFunction(array)
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [text for region, name in NAMES.items() for text in (str(region), name)]
    colours.IndexedColors = [0.49, 0.65, 0.84, 0.96, 0.74, 0.24, 0.70, 0.36, 0.38]
    SaveScreenshot(path, view, ImageResolution=[1000, 700])
    for proxy in (view, cut, solid, producer):
        Delete(proxy)


def Main(folder):
    """From voxels to a mesh; True if the check finds no fault with it."""
    from paraview.simple import SaveData, TrivialProducer

    os.makedirs(folder, exist_ok=True)
    materials = SimulateTopography()
    image = MakeImage(materials)
    mesh, interfaces = MakeMesh(image)
    print("%d voxels, %d faces between materials, %d triangles within %.2g voxels of them" % (
        materials.size, interfaces.GetNumberOfFaces(), interfaces.GetOutput().GetNumberOfCells(),
        interfaces.GetLargestDeviation() / VOXEL))
    regions = vtk_to_numpy(mesh.GetCellData().GetArray("RegionId"))
    for region, volume in enumerate(GetVolumes(mesh)):
        print("%-8s %6d voxels %9.3g um^3, %6d tetrahedra %9.3g um^3" % (
            NAMES[region], (materials == region).sum(), (materials == region).sum() * VOXEL**3,
            (regions == region).sum(), volume))
    certificate = get_texts(mesh, "Certificate")
    print("\n".join(certificate))
    Draw(image, "Material", os.path.join(folder, "voxel_topography_voxels.png"))
    Draw(mesh, "RegionId", os.path.join(folder, "voxel_topography.png"))
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(mesh)
    # Not appended, ParaView's default: Debian's ParaView 5.11 cannot read its own appended files.
    SaveData(os.path.join(folder, "voxel_topography.vtu"), proxy=producer, DataMode="Binary")
    return certificate[0].startswith(("DELAUNAY", "CLEAN FOR FINITE VOLUMES"))


if __name__ == "__main__":
    sys.exit(0 if Main(sys.argv[1] if len(sys.argv) > 1 else ".") else 1)
