# SPDX-License-Identifier: BSD-3-Clause
"""VTK's data sets as NumPy arrays and back, with VTK 9.1 and later."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any, List, Mapping, Sequence, Tuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

from .texts import encode, get_texts

if TYPE_CHECKING:
    from .data import Mesh, Surface

_TETRAHEDRON = 10


def get_points(data: Any) -> np.ndarray:
    """(n, 3) float64, the points of a vtkPointSet."""
    points = data.GetPoints()
    if points is None:
        return np.empty((0, 3))
    return vtk_to_numpy(points.GetData()).astype(np.float64, copy=False)


def _cell_rows(data: Any, name: str, first: int, count: int) -> Any:
    array = data.GetCellData().GetArray(name)
    return None if array is None else vtk_to_numpy(array)[first : first + count]


def to_surface(data: "vtkPolyData") -> "Surface":
    """The polygons of a vtkPolyData, see Surface.from_pyvista()."""
    from .data import Surface

    if data.GetNumberOfStrips() > 0:
        raise ValueError("Triangle strips are no polygons: use a vtkTriangleFilter before.")
    first = data.GetNumberOfVerts() + data.GetNumberOfLines()
    if first > 0:
        warnings.warn(f"{first} vertices and lines of the input are no polygons, and not used.")
    cells = data.GetPolys()
    return Surface(
        get_points(data),
        vtk_to_numpy(cells.GetConnectivityArray()),
        vtk_to_numpy(cells.GetOffsetsArray()),
        _cell_rows(data, "BoundaryLabels", first, data.GetNumberOfPolys()),
        _cell_rows(data, "StructuralFacetId", first, data.GetNumberOfPolys()),
        _cell_rows(data, "ContactId", first, data.GetNumberOfPolys()),
        get_texts(data, "ContactNames"),
        get_texts(data, "RegionNames"),
    )


def to_sizing(data: Any) -> Tuple[np.ndarray, ...]:
    """Points, lengths and tetrahedra of any data set with the point array Sizing."""
    lengths = data.GetPointData().GetArray("Sizing")
    if lengths is None or lengths.GetNumberOfComponents() != 1:
        raise ValueError("A sizing needs the point array Sizing, one positive length at each point.")
    if data.GetNumberOfCells() > 0:
        from vtkmodules.vtkFiltersGeneral import vtkDataSetTriangleFilter

        simplices = vtkDataSetTriangleFilter()
        simplices.TetrahedraOnlyOn()
        simplices.SetInputData(data)
        simplices.Update()
        grid = simplices.GetOutput()
        lengths = vtk_to_numpy(grid.GetPointData().GetArray("Sizing"))
        return get_points(grid), lengths, _tetrahedra(grid)
    if hasattr(data, "GetPoints"):
        return get_points(data), vtk_to_numpy(lengths)
    points = np.array([data.GetPoint(i) for i in range(data.GetNumberOfPoints())])
    return points, vtk_to_numpy(lengths)


def _tetrahedra(grid: "vtkUnstructuredGrid") -> np.ndarray:
    if grid.GetNumberOfCells() == 0:
        return np.empty((0, 4), np.int64)
    if not grid.IsHomogeneous() or grid.GetCellType(0) != _TETRAHEDRON:
        raise ValueError("The mesh has cells that are no tetrahedra.")
    return vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)


def to_mesh(grid: "vtkUnstructuredGrid") -> "Mesh":
    """The tetrahedra of a vtkUnstructuredGrid, see Mesh.from_pyvista()."""
    from .data import Mesh

    tetrahedra = _tetrahedra(grid)
    regions = grid.GetCellData().GetArray("RegionId")
    free = grid.GetPointData().GetArray("FreePoint")
    return Mesh(
        get_points(grid),
        tetrahedra,
        np.zeros(len(tetrahedra), np.int32) if regions is None else vtk_to_numpy(regions),
        is_free=np.empty(0, np.uint8) if free is None else vtk_to_numpy(free),
        region_names=get_texts(grid, "RegionNames"),
    )


# Cells are always copied: vtkCellArray makes arrays that share a buffer without knowing that NumPy owns
# the memory. Other arrays are copied unless that is asked for: then the array of VTK keeps that of NumPy.


def make_points(points: np.ndarray, copy: bool = True) -> vtkPoints:
    """From (n, 3) coordinates."""
    result = vtkPoints()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=copy))
    return result


def make_cells(offsets: np.ndarray, connectivity: np.ndarray) -> vtkCellArray:
    """Cell i has the points connectivity[offsets[i]:offsets[i + 1]]."""
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtk(np.ascontiguousarray(offsets, np.int32), deep=True),
        numpy_to_vtk(np.ascontiguousarray(connectivity, np.int32), deep=True),
    )
    return cells


def add_array(attributes: Any, name: str, values: Any, copy: bool = True) -> None:
    """Adds an array of numbers to point, cell or field data."""
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=copy)
    array.SetName(name)
    attributes.AddArray(array)


def add_texts(data: Any, name: str, lines: Sequence[str]) -> None:
    """Adds texts to the field data, see texts.py, unless there are none."""
    if not lines:
        return
    values, names = encode(lines)
    array = vtkIntArray()
    array.SetName(name)
    array.SetNumberOfComponents(len(values))
    array.SetNumberOfTuples(1)
    for i, value in enumerate(values):
        array.SetValue(i, value)
        array.SetComponentName(i, names[i])
    data.GetFieldData().AddArray(array)


def from_surface(surface: "Surface", copy: bool = True) -> "vtkPolyData":
    """See Surface.to_vtk()."""
    data = vtkPolyData()
    data.SetPoints(make_points(surface.points, copy))
    data.SetPolys(make_cells(surface.offsets, surface.connectivity))
    arrays = {
        "BoundaryLabels": surface.labels,
        "StructuralFacetId": surface.facets,
        "ContactId": surface.contact_ids,
    }
    for name, values in arrays.items():
        if values is not None:
            add_array(data.GetCellData(), name, values, copy)
    add_texts(data, "ContactNames", surface.contact_names)
    add_texts(data, "RegionNames", surface.region_names)
    return data


def from_mesh(mesh: "Mesh", copy: bool = True) -> "vtkUnstructuredGrid":
    """See Mesh.to_vtk()."""
    grid = vtkUnstructuredGrid()
    grid.SetPoints(make_points(mesh.points, copy))
    offsets = np.arange(0, 4 * len(mesh.tetrahedra) + 1, 4, dtype=np.int32)
    grid.SetCells(_TETRAHEDRON, make_cells(offsets, mesh.tetrahedra.reshape(-1)))
    add_array(grid.GetCellData(), "RegionId", mesh.regions, copy)
    if len(mesh.faults):
        add_array(grid.GetCellData(), "RefinementFault", mesh.faults, copy)
    if len(mesh.is_free):
        add_array(grid.GetPointData(), "FreePoint", mesh.is_free, copy)
    add_texts(grid, "Certificate", mesh.certificate.text.splitlines() if mesh.certificate else [])
    add_texts(grid, "RegionNames", mesh.region_names)
    return grid


def _read(path: str, readers: Mapping[str, str], others: Sequence[str] = ()) -> Any:
    """What the reader for the ending of the name gives; ValueError says what it has against the file.

    others: endings that are read without VTK, for the error.
    """
    import importlib
    import re

    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

    suffix = os.path.splitext(path)[1].lower()
    if suffix not in readers:
        raise ValueError(f"{path}: what is read are {', '.join([*others, *readers])}.")
    if not os.path.exists(path):
        raise FileNotFoundError(f"There is no file {path}.")
    module, name = readers[suffix].split(".")
    reader = getattr(importlib.import_module("vtkmodules." + module), name)()
    # What VTK says goes into the exception, not to the terminal.
    window, shown = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    logged = vtkLogger.GetCurrentVerbosityCutoff()
    vtkOutputWindow.SetInstance(window)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        reader.SetFileName(path)
        reader.Update()
    finally:
        vtkLogger.SetStderrVerbosity(logged)
        vtkOutputWindow.SetInstance(shown)
    data = reader.GetOutputDataObject(0)
    said = window.GetOutput() or ""
    if data is None or "ERR" in said:
        reason = re.search(r"\(0x[0-9a-f]+\): (.+)", said)
        text = f": {reason[1]}" if reason else "."
        raise ValueError(f"{path} cannot be read as {suffix}{text}")
    return data


def _merge_blocks(data: Any) -> Any:
    """The polygons of all blocks."""
    from vtkmodules.vtkFiltersCore import vtkAppendPolyData

    append = vtkAppendPolyData()
    iterator = data.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        block = iterator.GetCurrentDataObject()
        if block.IsA("vtkPolyData"):
            append.AddInputData(block)
        iterator.GoToNextItem()
    append.Update()
    return append.GetOutput()


def read_surface(path: str) -> "Surface":
    """Reads what VTK's readers of polygons know, by the ending of the file's name."""
    data = _read(
        path,
        {
            ".vtp": "vtkIOXML.vtkXMLPolyDataReader",
            ".vtk": "vtkIOLegacy.vtkGenericDataObjectReader",
            ".vtm": "vtkIOXML.vtkXMLMultiBlockDataReader",
            ".ply": "vtkIOPLY.vtkPLYReader",
            ".obj": "vtkIOGeometry.vtkOBJReader",
        },
        others=[".stl"],
    )
    if data.IsA("vtkCompositeDataSet"):
        data = _merge_blocks(data)
    if not data.IsA("vtkPolyData") or data.GetNumberOfPolys() == 0:
        raise ValueError(f"{path} has no polygons.")
    return to_surface(data)


def read_mesh(path: str) -> "Mesh":
    """Reads the tetrahedra of a .vtu or .vtk file."""
    data = _read(
        path,
        {
            ".vtu": "vtkIOXML.vtkXMLUnstructuredGridReader",
            ".vtk": "vtkIOLegacy.vtkGenericDataObjectReader",
        },
    )
    if not data.IsA("vtkUnstructuredGrid") or data.GetNumberOfCells() == 0:
        raise ValueError(f"{path} has no tetrahedra.")
    return to_mesh(data)


def read_labels(path: str, name: str = "") -> Tuple[List[np.ndarray], np.ndarray]:
    """Coordinates of the corners along each axis, and the labels of the cells of voxels.

    A .vti file has them at its cells or, if it has none there, at its points, which are the centers of
    voxels then.
    """
    data = _read(path, {".vti": "vtkIOXML.vtkXMLImageDataReader",
                        ".vtr": "vtkIOXML.vtkXMLRectilinearGridReader"})
    return get_labels(data, name, path)


def get_labels(data: Any, name: str = "", path: str = "The data set") -> Tuple[
    List[np.ndarray], np.ndarray
]:
    """As read_labels(), from a vtkImageData or vtkRectilinearGrid."""
    cells, points = data.GetCellData(), data.GetPointData()
    array = cells.GetArray(name) if name else cells.GetScalars() or cells.GetArray(0)
    at_points = array is None
    if at_points:
        array = points.GetArray(name) if name else points.GetScalars() or points.GetArray(0)
    if array is None or array.GetNumberOfComponents() != 1:
        raise ValueError(f"{path} has no array {name or 'of labels'} with one number for each voxel.")
    if data.IsA("vtkImageData"):
        if list(data.GetDirectionMatrix().GetData()) != [1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0]:
            raise ValueError(f"{path} is turned by a direction matrix, which is not supported.")
        extent, origin, spacing = data.GetExtent(), data.GetOrigin(), data.GetSpacing()
        axes = [
            origin[a] + spacing[a] * np.arange(extent[2 * a], extent[2 * a + 1] + 1.0)
            for a in range(3)
        ]
    else:
        axes = [
            vtk_to_numpy(values).astype(np.float64)
            for values in (data.GetXCoordinates(), data.GetYCoordinates(), data.GetZCoordinates())
        ]
    if at_points:
        axes = [_corners_around(axis, path) for axis in axes]
    return axes, vtk_to_numpy(array)


def _corners_around(centers: np.ndarray, path: str) -> np.ndarray:
    if len(centers) < 2:
        raise ValueError(f"{path} has fewer than two points along an axis.")
    middle = 0.5 * (centers[1:] + centers[:-1])
    return np.concatenate([[2 * centers[0] - middle[0]], middle, [2 * centers[-1] - middle[-1]]])
