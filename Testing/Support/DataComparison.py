# SPDX-License-Identifier: BSD-3-Clause
"""Exact comparison of data sets: the same points, cells and arrays, bit by bit and in the same order.

    Read(path), Write(data, path)       .vtp, .vtu, .vti and .stl
    FindDifference(data, reference)     None if they are the same, else a sentence
    python3 DataComparison.py           tests itself

Field data are left out: they are texts and counts about a mesh, which have tests of their own.
"""

import os

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TRIANGLE, vtkPolyData
from vtkmodules.vtkIOGeometry import vtkSTLReader, vtkSTLWriter
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader, vtkXMLImageDataWriter, vtkXMLPolyDataReader, vtkXMLPolyDataWriter,
    vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter)

READERS = {".vtp": vtkXMLPolyDataReader, ".vtu": vtkXMLUnstructuredGridReader,
           ".vti": vtkXMLImageDataReader, ".stl": vtkSTLReader}
WRITERS = {".vtp": vtkXMLPolyDataWriter, ".vtu": vtkXMLUnstructuredGridWriter,
           ".vti": vtkXMLImageDataWriter, ".stl": vtkSTLWriter}


def GetExtension(data):
    """What a file of these data ends with."""
    return {"vtkPolyData": ".vtp", "vtkUnstructuredGrid": ".vtu",
            "vtkImageData": ".vti"}[data.GetClassName()]


def Read(path):
    """The data set in a file."""
    if not os.path.exists(path):
        raise FileNotFoundError(path)
    reader = READERS[os.path.splitext(path)[1]]()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def Write(data, path):
    """A small file that any ParaView opens: that of Debian 12 cannot read appended data."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    extension = os.path.splitext(path)[1]
    writer = WRITERS[extension]()
    writer.SetFileName(path)
    writer.SetInputData(data)
    if extension == ".stl":
        writer.SetFileTypeToBinary()
    else:
        writer.SetDataModeToBinary()
        writer.SetCompressionLevel(9)
    if writer.Write() != 1:
        raise OSError("cannot write " + path)


def GetCells(data):
    """The cells as named arrays of numbers."""
    lists = {}
    if data.IsA("vtkPolyData"):
        lists = {"vertices": data.GetVerts(), "lines": data.GetLines(), "polygons": data.GetPolys(),
                 "strips": data.GetStrips()}
    elif data.IsA("vtkUnstructuredGrid"):
        lists = {"cells": data.GetCells()}
    arrays = {}
    for name, cells in lists.items():
        arrays["offsets of " + name] = cells.GetOffsetsArray()
        arrays["point ids of " + name] = cells.GetConnectivityArray()
    if data.IsA("vtkUnstructuredGrid"):
        arrays["cell types"] = data.GetCellTypesArray()
        arrays["faces"] = data.GetFaces()
    return arrays


def GetArrays(data):
    """Everything that makes a data set, but for its field data: named arrays of numbers."""
    arrays = GetCells(data)
    if data.IsA("vtkPointSet") and data.GetPoints():
        arrays["coordinates"] = data.GetPoints().GetData()
    for kind, attributes in (("point", data.GetPointData()), ("cell", data.GetCellData())):
        for i in range(attributes.GetNumberOfArrays()):
            array = attributes.GetArray(i)
            arrays["%s array %s" % (kind, array.GetName())] = array
    named = {name: vtk_to_numpy(array) for name, array in arrays.items()
             if array is not None and array.GetNumberOfTuples() > 0}
    if data.IsA("vtkImageData"):
        named["grid"] = numpy.array([data.GetDimensions(), data.GetOrigin(), data.GetSpacing()])
    return named


def FindDifference(data, reference):
    """None if two data sets are the same, else a sentence."""
    if data.GetClassName() != reference.GetClassName():
        return "%s instead of %s" % (data.GetClassName(), reference.GetClassName())
    counts, expected = ((one.GetNumberOfPoints(), one.GetNumberOfCells())
                        for one in (data, reference))
    if counts != expected:
        return "%d points and %d cells instead of %d and %d" % (counts + expected)
    arrays, references = GetArrays(data), GetArrays(reference)
    if arrays.keys() != references.keys():
        return "arrays %s instead of %s" % (sorted(arrays.keys() - references.keys()),
                                            sorted(references.keys() - arrays.keys()))
    for name, array in arrays.items():
        other = references[name]
        if array.shape != other.shape:
            return "%s of shape %s instead of %s" % (name, array.shape, other.shape)
        isOther = (array != other) & ~((array != array) & (other != other))
        if isOther.any():
            first = tuple(numpy.argwhere(isOther)[0])
            return "%s: %d of %d values differ, the first at %s: %.17g instead of %.17g" % (
                name, isOther.sum(), isOther.size, list(map(int, first)), array[first], other[first])
    return None


def TestSelf():
    """The comparison sees the last bit of a coordinate, another order, and a missing array."""
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataType(VTK_DOUBLE)
    for corner in ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.1, 0.0)):
        points.InsertNextPoint(corner)
    data.SetPoints(points)
    data.Allocate(1)
    data.InsertNextCell(VTK_TRIANGLE, 3, (0, 1, 2))
    assert FindDifference(data, data) is None

    def Change(change):
        copy = vtkPolyData()
        copy.DeepCopy(data)
        change(copy)
        return FindDifference(copy, data)

    def MovePoint(copy):
        vtk_to_numpy(copy.GetPoints().GetData())[2, 1] = numpy.nextafter(0.1, 1.0)

    def TurnTriangle(copy):
        vtk_to_numpy(copy.GetPolys().GetConnectivityArray())[:] = (1, 2, 0)

    def AddArray(copy):
        array = numpy_to_vtk(numpy.array([7]), deep=True)
        array.SetName("RegionId")
        copy.GetCellData().AddArray(array)

    assert "coordinates" in Change(MovePoint)
    assert "point ids" in Change(TurnTriangle)
    assert "RegionId" in Change(AddArray)
    print("data comparison: ok")


if __name__ == "__main__":
    TestSelf()
