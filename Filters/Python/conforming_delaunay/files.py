# SPDX-License-Identifier: BSD-3-Clause
"""Files: STL in and VTU out with NumPy alone; what VTK and meshio know, where installed."""

from __future__ import annotations

import base64
import os
from typing import TYPE_CHECKING, Any, List, Sequence, Union

import numpy as np

from .texts import encode

if TYPE_CHECKING:
    from .data import Mesh, Surface

Path = Union[str, "os.PathLike[str]"]


def read_surface(path: Path) -> "Surface":
    """Reads polygons; ValueError says what is wrong with the file."""
    suffix = os.path.splitext(os.fspath(path))[1].lower()
    if suffix == ".stl":
        return read_stl(path)
    try:
        from . import vtk_data
    except ImportError:
        return _read_with_meshio(path)
    return vtk_data.read_surface(os.fspath(path))


def read_stl(path: Path) -> "Surface":
    """Reads an STL file, binary or text. Equal coordinates become one point."""
    from .data import Surface

    with open(path, "rb") as file:
        content = file.read()
    count = int.from_bytes(content[80:84], "little")
    if len(content) >= 84 and len(content) == 84 + 50 * count:
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
        corners = np.frombuffer(content, record, count, 84)["corners"].reshape(-1, 3)
    else:
        words = content.split()
        starts = [i + 1 for i, word in enumerate(words) if word.lower() == b"vertex"]
        try:
            corners = np.array([words[i : i + 3] for i in starts], np.float64).reshape(-1, 3)
        except ValueError:
            raise ValueError(f"{os.fspath(path)} is no STL file, or it is cut off.") from None
        if len(corners) == 0 or len(corners) % 3 != 0:
            raise ValueError(f"{os.fspath(path)} is no STL file, or it is cut off.")
    points, inverse = np.unique(corners.astype(np.float64), axis=0, return_inverse=True)
    # In the order in which the file has them.
    first = np.full(len(points), len(corners), np.int64)
    inverse = inverse.reshape(-1)
    np.minimum.at(first, inverse, np.arange(len(corners)))
    order = np.argsort(first)
    places = np.empty(len(points), np.int64)
    places[order] = np.arange(len(points))
    return Surface.from_triangles(points[order], places[inverse].reshape(-1, 3))


def _read_with_meshio(path: Path) -> "Surface":
    from .data import Surface

    try:
        import meshio
    except ImportError:
        raise ValueError(
            f"{os.fspath(path)}: STL files are read with NumPy alone; others need vtk or meshio, "
            "neither of which is installed."
        ) from None
    mesh = meshio.read(path)
    polygons = [row for block in mesh.cells if block.dim == 2 for row in block.data]
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    return Surface.from_any((points, polygons))


def read_mesh(path: Path) -> "Mesh":
    """Reads tetrahedra and their regions; ValueError says what is wrong with the file."""
    from .data import Mesh

    name = os.fspath(path)
    if not os.path.exists(name):
        raise FileNotFoundError(f"There is no file {name}.")
    try:
        from . import vtk_data
    except ImportError:
        pass
    else:
        if os.path.splitext(name)[1].lower() in (".vtu", ".vtk"):
            return vtk_data.read_mesh(name)
    try:
        import meshio
    except ImportError:
        raise ValueError(
            f"{name}: meshes are read from .vtu and .vtk by VTK, and from others by meshio: install "
            "one of them."
        ) from None
    read = meshio.read(path)
    blocks = [i for i, block in enumerate(read.cells) if block.type == "tetra"]
    if not blocks:
        raise ValueError(f"{name} has no tetrahedra.")
    tetrahedra = np.concatenate([read.cells[i].data for i in blocks])
    regions = np.zeros(len(tetrahedra), np.int32)
    for key in ("RegionId", "gmsh:physical"):
        if key in read.cell_data:
            regions = np.concatenate([read.cell_data[key][i] for i in blocks])
            break
    return Mesh(np.asarray(read.points, np.float64), tetrahedra, regions)


def write_mesh(path: Path, mesh: "Mesh") -> None:
    """Writes a mesh; the ending of the name tells the format."""
    if os.path.splitext(os.fspath(path))[1].lower() == ".vtu":
        write_vtu(path, mesh)
        return
    try:
        import meshio
    except ImportError:
        raise ValueError(
            f"{os.fspath(path)}: VTU files are written with NumPy alone; others need meshio, which "
            "is not installed."
        ) from None
    meshio.write(path, mesh.to_meshio())


def write_vtu(path: Path, mesh: "Mesh") -> None:
    """Writes a VTU file that ParaView, PyVista and meshio read."""
    count = len(mesh.tetrahedra)
    cell_data = [("RegionId", mesh.regions)]
    if len(mesh.faults):
        cell_data.append(("RefinementFault", mesh.faults))
    point_data = [("FreePoint", mesh.is_free)] if len(mesh.is_free) else []
    texts = [("Certificate", mesh.certificate.text.splitlines())] if mesh.certificate else []
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64">',
        "<UnstructuredGrid>",
        "<FieldData>",
        *(_texts(name, lines) for name, lines in texts),
        "</FieldData>",
        f'<Piece NumberOfPoints="{len(mesh.points)}" NumberOfCells="{count}">',
        "<PointData>",
        *(_data_array(name, values) for name, values in point_data),
        "</PointData>",
        "<CellData>",
        *(_data_array(name, values) for name, values in cell_data),
        "</CellData>",
        "<Points>",
        _data_array("Points", mesh.points),
        "</Points>",
        "<Cells>",
        _data_array("connectivity", mesh.tetrahedra.reshape(-1).astype(np.int64)),
        _data_array("offsets", np.arange(4, 4 * count + 1, 4, dtype=np.int64)),
        _data_array("types", np.full(count, 10, np.uint8)),
        "</Cells>",
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def _texts(name: str, lines: List[str]) -> str:
    return _data_array(name, np.arange(len(lines), dtype=np.int32).reshape(1, -1), lines)


def _data_array(name: str, values: Any, component_names: Sequence[str] = ()) -> str:
    kinds = {"f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}
    array = np.asarray(values)
    kind = array.dtype.str[1:]
    content = np.ascontiguousarray(array, "<" + kind).tobytes()
    components = array.shape[1] if array.ndim == 2 else 1
    encoded = base64.b64encode(len(content).to_bytes(8, "little") + content).decode()
    names = [f'ComponentName{i}="{encode(text)}" ' for i, text in enumerate(component_names)]
    # Of field data all rows count, of others those of the points or cells.
    rows = f'NumberOfTuples="{len(array)}" ' if component_names else ""
    return (
        f'<DataArray type="{kinds[kind]}" Name="{name}" NumberOfComponents="{components}" '
        f'{"".join(names)}{rows}format="binary">{encoded}</DataArray>'
    )
