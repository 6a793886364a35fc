# SPDX-License-Identifier: BSD-3-Clause
"""VTK's data sets as NumPy arrays and back, with VTK 9.1 and later."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any, List, Tuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

from .texts import encode

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
    """The polygons of a vtkPolyData with BoundaryLabels and StructuralFacetId."""
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
    """Tetrahedra, with RegionId and FreePoint."""
    from .data import Mesh

    tetrahedra = _tetrahedra(grid)
    regions = grid.GetCellData().GetArray("RegionId")
    free = grid.GetPointData().GetArray("FreePoint")
    return Mesh(
        get_points(grid),
        tetrahedra,
        np.zeros(len(tetrahedra), np.int32) if regions is None else vtk_to_numpy(regions),
        is_free=np.empty(0, np.uint8) if free is None else vtk_to_numpy(free),
    )


# Arrays are copied: VTK shares buffers between arrays without knowing that NumPy owns the memory.


def make_points(points: np.ndarray) -> vtkPoints:
    """From (n, 3) coordinates."""
    result = vtkPoints()
    result.SetData(numpy_to_vtk(points, deep=True))
    return result


def make_cells(offsets: np.ndarray, connectivity: np.ndarray) -> vtkCellArray:
    """Cell i has the points connectivity[offsets[i]:offsets[i + 1]]."""
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtk(np.ascontiguousarray(offsets, np.int32), deep=True),
        numpy_to_vtk(np.ascontiguousarray(connectivity, np.int32), deep=True),
    )
    return cells


def add_array(attributes: Any, name: str, values: Any) -> None:
    """Adds an array of numbers to point, cell or field data."""
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)


def add_texts(data: Any, name: str, lines: List[str]) -> None:
    """Adds texts to the field data, see texts.py."""
    array = vtkIntArray()
    array.SetName(name)
    array.SetNumberOfComponents(len(lines))
    array.SetNumberOfTuples(1)
    for i, line in enumerate(lines):
        array.SetValue(i, i)
        array.SetComponentName(i, encode(line))
    data.GetFieldData().AddArray(array)


def from_surface(surface: "Surface") -> "vtkPolyData":
    """See Surface.to_vtk()."""
    data = vtkPolyData()
    data.SetPoints(make_points(surface.points))
    data.SetPolys(make_cells(surface.offsets, surface.connectivity))
    if surface.labels is not None:
        add_array(data.GetCellData(), "BoundaryLabels", surface.labels)
    if surface.facets is not None:
        add_array(data.GetCellData(), "StructuralFacetId", surface.facets)
    return data


def from_mesh(mesh: "Mesh") -> "vtkUnstructuredGrid":
    """See Mesh.to_vtk()."""
    grid = vtkUnstructuredGrid()
    grid.SetPoints(make_points(mesh.points))
    offsets = np.arange(0, 4 * len(mesh.tetrahedra) + 1, 4, dtype=np.int32)
    grid.SetCells(_TETRAHEDRON, make_cells(offsets, mesh.tetrahedra.reshape(-1)))
    add_array(grid.GetCellData(), "RegionId", mesh.regions)
    if len(mesh.faults):
        add_array(grid.GetCellData(), "RefinementFault", mesh.faults)
    if len(mesh.is_free):
        add_array(grid.GetPointData(), "FreePoint", mesh.is_free)
    if mesh.certificate:
        add_texts(grid, "Certificate", mesh.certificate.text.splitlines())
    return grid


def read_surface(path: str) -> "Surface":
    """Reads what VTK's readers of polygons know, by the ending of the file's name."""
    from vtkmodules.vtkIOGeometry import vtkOBJReader
    from vtkmodules.vtkIOLegacy import vtkPolyDataReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    readers = {
        ".vtp": vtkXMLPolyDataReader,
        ".vtk": vtkPolyDataReader,
        ".ply": vtkPLYReader,
        ".obj": vtkOBJReader,
    }
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in readers:
        raise ValueError(f"{path}: surfaces are read from .stl, {', '.join(readers)}.")
    if not os.path.exists(path):
        raise FileNotFoundError(path)
    reader = readers[suffix]()
    reader.SetFileName(path)
    reader.Update()
    if reader.GetOutput().GetNumberOfPolys() == 0:
        raise ValueError(f"{path} has no polygons.")
    return to_surface(reader.GetOutput())


def read_mesh(path: str) -> "Mesh":
    """Reads the tetrahedra of a .vtu or .vtk file."""
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    is_xml = path.lower().endswith(".vtu")
    reader = vtkXMLUnstructuredGridReader() if is_xml else vtkUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    if reader.GetOutput().GetNumberOfCells() == 0:
        raise ValueError(f"{path} has no tetrahedra.")
    return to_mesh(reader.GetOutput())
