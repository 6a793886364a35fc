# SPDX-License-Identifier: BSD-3-Clause
"""The models in Data/Input are what is made here, small, and can be read by any ParaView.

With CDM_UPDATE_BASELINES=1 in the environment what is made here becomes the files.
"""

import math
import os
import sys

import DataComparison
import numpy
from conforming_delaunay import vtkTechnologyStructureSource
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_INT, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData

sys.path.insert(0, os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples"))
import voxel_topography  # noqa: E402 (found in the folder above)

FOLDER = os.path.join(os.environ["CDM_DATA_DIR"], "Input")
MAXIMUM_BYTES = 200000


def MakeDevice(structure):
    """Polygons of a sample device, in micrometres."""
    device = vtkTechnologyStructureSource()
    device.SetStructure(structure)
    device.Update()
    return device.GetOutput()


def MakePolygons(points, polygons):
    """A vtkPolyData of rows of coordinates and lists of point ids."""
    data = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(numpy.array(points, dtype=float), deep=True))
    data.SetPoints(coordinates)
    cells = vtkCellArray()
    for ids in polygons:
        cells.InsertNextCell(len(ids), ids)
    data.SetPolys(cells)
    return data


def MakeMaterials():
    """A block of two materials that meet at a slanted plane, an octahedron inside, a pyramid on top.

    The top of the second material has a square hole, where the pyramid stands: two C-shaped
    polygons around it. Lengths in millimetres.
    """
    points, polygons, labels = [], [], []

    def Add(label, *corners):
        """A polygon by its corners: the first region is in front of it, where it turns left."""
        for corner in corners:
            if corner not in points:
                points.append(corner)
        polygons.append([points.index(corner) for corner in corners])
        labels.append(label)

    steel, copper, ceramic, glue = range(4)
    outside = -1
    # Ends of the slanted plane: x at the bottom and at the top.
    low, high = 1.5, 2.5
    Add((outside, steel), (0, 0, 0), (0, 2, 0), (low, 2, 0), (low, 0, 0))
    Add((outside, steel), (0, 0, 2), (high, 0, 2), (high, 2, 2), (0, 2, 2))
    Add((outside, steel), (0, 0, 0), (0, 0, 2), (0, 2, 2), (0, 2, 0))
    Add((outside, steel), (0, 0, 0), (low, 0, 0), (high, 0, 2), (0, 0, 2))
    Add((outside, steel), (0, 2, 0), (0, 2, 2), (high, 2, 2), (low, 2, 0))
    Add((copper, steel), (low, 0, 0), (low, 2, 0), (high, 2, 2), (high, 0, 2))
    Add((outside, copper), (low, 0, 0), (low, 2, 0), (5, 2, 0), (5, 0, 0))
    Add((outside, copper), (5, 0, 0), (5, 2, 0), (5, 2, 2), (5, 0, 2))
    Add((outside, copper), (low, 0, 0), (5, 0, 0), (5, 0, 2), (high, 0, 2))
    Add((outside, copper), (low, 2, 0), (high, 2, 2), (5, 2, 2), (5, 2, 0))
    base = [(3, 0.5, 2), (4, 0.5, 2), (4, 1.5, 2), (3, 1.5, 2)]
    Add((outside, copper), (high, 0, 2), (5, 0, 2), (5, 1, 2), (4, 1, 2), base[1], base[0],
        (3, 1, 2), (high, 1, 2))
    Add((outside, copper), (high, 1, 2), (3, 1, 2), base[3], base[2], (4, 1, 2), (5, 1, 2),
        (5, 2, 2), (high, 2, 2))
    Add((glue, copper), *base)
    for i in range(4):
        Add((outside, glue), base[i], base[(i + 1) % 4], (3.5, 1, 2.75))
    ring = [(4.125, 1, 0.875), (3.5, 1.625, 0.875), (2.875, 1, 0.875), (3.5, 0.375, 0.875)]
    for i in range(4):
        Add((copper, ceramic), ring[i], ring[(i + 1) % 4], (3.5, 1, 1.5))
        Add((copper, ceramic), ring[(i + 1) % 4], ring[i], (3.5, 1, 0.25))
    surface = MakePolygons(points, polygons)
    array = numpy_to_vtk(numpy.array(labels), deep=True, array_type=VTK_INT)
    array.SetName("BoundaryLabels")
    surface.GetCellData().AddArray(array)
    names = vtkStringArray()
    names.SetName("RegionNames")
    for name in ("Steel", "Copper", "Ceramic", "Glue"):
        names.InsertNextValue(name)
    surface.GetFieldData().AddArray(names)
    return surface


def MakeSquareWithHole(center, half, radius, segments):
    """Points on the edge of a square and on a circle in it, one for one, counterclockwise."""
    side = segments // 4
    square, circle = [], []
    for i in range(segments):
        along = -half + 2.0 * half * (i % side) / side
        x, y = ((along, -half), (half, along), (-along, half), (-half, -along))[i // side]
        square.append((center[0] + x, center[1] + y))
        angle = math.atan2(y, x)
        circle.append((center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)))
    return square, circle


def MakeBracket():
    """An angle of 44 x 20 x 24 millimetres: a plate with two holes, and a wall beside it, triangles.

    The coordinates are those of an STL file, in single precision.
    """
    thickness, half, radius, segments = 4.0, 10.0, 5.0, 24
    side = segments // 4
    triangles = []

    def AddFan(*corners):
        """Triangles from the first corner of a polygon; they turn left seen from outside."""
        for second, third in zip(corners[1:-1], corners[2:]):
            triangles.append((corners[0], second, third))

    def AddPlate(center):
        """Top and bottom of a square around a hole, and the hole."""
        square, circle = MakeSquareWithHole(center, half, radius, segments)
        for i in range(segments):
            a, b = square[i], square[(i + 1) % segments]
            c, d = circle[(i + 1) % segments], circle[i]
            AddFan(*((x, y, thickness) for x, y in (a, b, c, d)))
            AddFan(*((x, y, 0.0) for x, y in (d, c, b, a)))
            AddFan((*d, thickness), (*c, thickness), (*c, 0.0), (*d, 0.0))
        return square

    left = AddPlate((half, half))
    right = AddPlate((3.0 * half, half))
    # The outer sides of the plate: the square's points in pairs, from their first side on.
    front = left[:side] + right[:side + 1]
    back = right[2 * side:3 * side] + left[2 * side:3 * side + 1]
    for outline in (front, right[side:2 * side + 1], back):
        for a, b in zip(outline[:-1], outline[1:]):
            AddFan((*a, 0.0), (*b, 0.0), (*b, thickness), (*a, thickness))
    # The wall at negative x: 24 high. Its sides fit to the points of the plate.
    seam = [(0.0, 2.0 * half - 2.0 * half * i / side) for i in range(side + 1)]  # y falls
    top = 24.0
    low, upper = -thickness, 2.0 * half
    AddFan((0.0, upper, top), *((x, y, thickness) for x, y in seam), (0.0, 0.0, top))
    AddFan((low, 0.0, 0.0), *((x, y, 0.0) for x, y in reversed(seam)), (low, upper, 0.0))
    AddFan((low, 0.0, 0.0), (low, 0.0, top), (low, upper, top), (low, upper, 0.0))
    AddFan((low, 0.0, top), (0.0, 0.0, top), (0.0, upper, top), (low, upper, top))
    AddFan((low, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, thickness), (0.0, 0.0, top),
           (low, 0.0, top))
    AddFan((low, upper, top), (0.0, upper, top), (0.0, upper, thickness), (0.0, upper, 0.0),
           (low, upper, 0.0))
    corners = numpy.array(triangles, dtype=numpy.float32).reshape(-1, 3)
    # As vtkSTLReader merges them: in the order in which they are met first.
    _, first, inverse = numpy.unique(corners, axis=0, return_index=True, return_inverse=True)
    rank = numpy.argsort(numpy.argsort(first))
    surface = MakePolygons(corners[numpy.sort(first)],
                           rank[inverse.reshape(-1)].reshape(-1, 3).tolist())
    points = vtkPoints()
    points.SetData(numpy_to_vtk(corners[numpy.sort(first)], deep=True))
    surface.SetPoints(points)
    return surface


def MakeVoxels(materials, spacing):
    """Materials of voxels, an array with the axes z, y, x, as cells of an image."""
    image = vtkImageData()
    image.SetDimensions(*(n + 1 for n in materials.shape[::-1]))
    image.SetSpacing(spacing, spacing, spacing)
    labels = numpy_to_vtk(materials.ravel(), deep=True, array_type=VTK_INT)
    labels.SetName("Material")
    image.GetCellData().SetScalars(labels)
    return image


def MakeBalls():
    """Two balls that have grown together, in voxels of 0.05 micrometres; -1 is empty."""
    z, y, x = 2 * numpy.indices((16, 18, 28)) + 1  # centers, in half voxels
    materials = numpy.full(x.shape, -1)
    materials[(x - 18) ** 2 + (y - 18) ** 2 + (z - 16) ** 2 < 14**2] = 0
    materials[(x - 38) ** 2 + (y - 18) ** 2 + (z - 16) ** 2 < 12**2] = 1
    return MakeVoxels(materials, 0.05)


MAKERS = {
    "mos_transistor.vtp": lambda: MakeDevice(vtkTechnologyStructureSource.MOS_TRANSISTOR),
    "via_plug.vtp": lambda: MakeDevice(vtkTechnologyStructureSource.VIA_PLUG),
    "materials.vtp": MakeMaterials,
    "bracket.stl": MakeBracket,
    "lined_trench.vti": lambda: voxel_topography.MakeImage(voxel_topography.SimulateTopography()),
    "balls.vti": MakeBalls,
}

faults = []
for name, make in MAKERS.items():
    path = os.path.join(FOLDER, name)
    data = make()
    if os.environ.get("CDM_UPDATE_BASELINES") == "1":
        DataComparison.Write(data, path)
    difference = DataComparison.FindDifference(DataComparison.Read(path), data)
    if difference is not None:
        faults.append("%s: %s" % (name, difference))
    with open(path, "rb") as file:
        content = file.read()
    print("%-20s %6d bytes, %5d points, %5d cells" % (
        name, len(content), data.GetNumberOfPoints(), data.GetNumberOfCells()))
    if len(content) > MAXIMUM_BYTES:
        faults.append(name + " is too large")
    if b'format="appended"' in content:
        faults.append(name + " cannot be read by ParaView 5.11 of Debian 12")
if sorted(MAKERS) != sorted(os.listdir(FOLDER)):
    faults.append("the folder holds %s" % sorted(os.listdir(FOLDER)))
print("\n".join(faults) or "%d inputs" % len(MAKERS))
sys.exit(1 if faults else 0)
