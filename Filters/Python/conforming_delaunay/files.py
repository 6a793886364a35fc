# SPDX-License-Identifier: BSD-3-Clause
"""Files: STL in, VTU, VTK and MSH out with NumPy alone; what VTK and meshio know, where installed."""

from __future__ import annotations

import base64
import os
from typing import TYPE_CHECKING, Any, List, Sequence, Tuple, Union
from urllib.parse import quote

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


def check_folder(path: Path) -> None:
    """FileNotFoundError if a file has no folder to be written into."""
    folder = os.path.dirname(os.fspath(path))
    if folder and not os.path.isdir(folder):
        raise FileNotFoundError(f"There is no folder {folder}.")


def check_mesh_path(path: Path, *, gmsh_format: str = "2.2", scale: float = 1.0) -> None:
    """Raises what write_mesh() would, as far as that is known before there is a mesh."""
    check_folder(path)
    name = os.fspath(path)
    suffix = os.path.splitext(name)[1].lower()
    if suffix == ".msh":
        from .gmsh import check_options

        check_options(gmsh_format, scale)
    elif suffix in (".stl", ".obj"):
        raise ValueError(f"{name} would have no tetrahedra: save the boundary there, mesh.boundary.save().")
    elif suffix not in (".vtu", ".vtk"):
        try:
            import meshio
        except ImportError:
            raise ValueError(
                f"{name}: .vtu, .vtk and .msh are written with NumPy alone; others need meshio, which "
                "is not installed."
            ) from None
        if not name.lower().endswith(tuple(meshio.extension_to_filetypes)):
            raise ValueError(f"{name} cannot be written: no format has this ending.")


def write_mesh(
    path: Path, mesh: "Mesh", *, gmsh_format: str = "2.2", scale: float = 1.0
) -> None:
    """Writes a mesh; the ending of the name tells the format. See Mesh.save()."""
    check_mesh_path(path, gmsh_format=gmsh_format, scale=scale)
    name = os.fspath(path)
    suffix = os.path.splitext(name)[1].lower()
    if suffix == ".vtu":
        write_vtu(path, mesh)
    elif suffix == ".vtk":
        write_vtk(path, mesh)
    elif suffix == ".msh":
        from .gmsh import write_msh

        write_msh(path, mesh, gmsh_format=gmsh_format, scale=scale)
    else:
        import meshio

        try:
            meshio.write(path, mesh.to_meshio())
        except (meshio.ReadError, meshio.WriteError) as error:
            raise ValueError(f"{name} cannot be written: {error}") from None


Arrays = List[Tuple[str, Any]]


def _mesh_arrays(mesh: "Mesh") -> Tuple[Arrays, Arrays, List[Tuple[str, List[str]]]]:
    """Point arrays, cell arrays and texts of a mesh, by name."""
    cell_data: Arrays = [("RegionId", mesh.regions)]
    if len(mesh.faults):
        cell_data.append(("RefinementFault", mesh.faults))
    point_data: Arrays = [("FreePoint", mesh.is_free)] if len(mesh.is_free) else []
    texts = []
    if mesh.certificate:
        texts.append(("Certificate", mesh.certificate.text.splitlines()))
    if mesh.region_names:
        texts.append(("RegionNames", mesh.region_names))
    return point_data, cell_data, texts


def write_vtk(path: Path, mesh: "Mesh") -> None:
    """Writes a legacy VTK file, binary, that ParaView, PyVista and meshio read."""
    point_data, cell_data, texts = _mesh_arrays(mesh)
    count = len(mesh.tetrahedra)
    kinds = {"f8": "double", "i4": "int", "u1": "unsigned_char"}

    def numbers(values: Any) -> bytes:
        array = np.ascontiguousarray(values)
        return array.astype(array.dtype.newbyteorder(">")).tobytes() + b"\n"

    def fields(name: str, arrays: Arrays, metadata: Sequence[Sequence[str]] = ()) -> bytes:
        content = f"FIELD {name} {len(arrays)}\n".encode()
        for i, (label, values) in enumerate(arrays):
            array = np.asarray(values)
            width = array.shape[1] if array.ndim == 2 else 1
            kind = kinds[array.dtype.str[1:]]
            content += f"{label} {width} {len(array)} {kind}\n".encode() + numbers(array)
            if metadata:
                # The writer of VTK encodes names of components a second time.
                names = "".join(quote(piece, safe="") + "\n" for piece in metadata[i])
                content += f"METADATA\nCOMPONENT_NAMES\n{names}\n".encode()
        return content

    cells = np.empty((count, 5), np.int32)
    cells[:, 0] = 4
    cells[:, 1:] = mesh.tetrahedra
    with open(path, "wb") as file:
        file.write(b"# vtk DataFile Version 4.2\nTetrahedra\nBINARY\nDATASET UNSTRUCTURED_GRID\n")
        if texts:
            lists = [(name, *encode(lines)) for name, lines in texts]
            rows: Arrays = [(name, np.array([values], np.int32)) for name, values, _ in lists]
            file.write(fields("FieldData", rows, [pieces for _, _, pieces in lists]))
        file.write(f"POINTS {len(mesh.points)} double\n".encode() + numbers(mesh.points))
        file.write(f"CELLS {count} {5 * count}\n".encode() + numbers(cells))
        file.write(f"CELL_TYPES {count}\n".encode() + numbers(np.full(count, 10, np.int32)))
        file.write(f"CELL_DATA {count}\n".encode() + fields("FieldData", cell_data))
        if point_data:
            head = f"POINT_DATA {len(mesh.points)}\n".encode()
            file.write(head + fields("FieldData", point_data))


def write_vtu(path: Path, mesh: "Mesh") -> None:
    """Writes a VTU file that ParaView, PyVista and meshio read."""
    count = len(mesh.tetrahedra)
    point_data, cell_data, texts = _mesh_arrays(mesh)
    cells = [
        ("connectivity", mesh.tetrahedra.reshape(-1).astype(np.int64)),
        ("offsets", np.arange(4, 4 * count + 1, 4, dtype=np.int64)),
        ("types", np.full(count, 10, np.uint8)),
    ]
    sections = [
        ("PointData", point_data),
        ("CellData", cell_data),
        ("Points", [("Points", mesh.points)]),
        ("Cells", cells),
    ]
    _write_xml(path, "UnstructuredGrid", f'NumberOfCells="{count}"', mesh.points, sections, texts)


def check_surface_path(path: Path) -> None:
    """Raises what write_surface() would, as far as that is known before there is a surface."""
    check_folder(path)
    if os.path.splitext(os.fspath(path))[1].lower() not in (".vtp", ".stl"):
        raise ValueError(f"{os.fspath(path)}: surfaces are written as .vtp or .stl.")


def write_surface(path: Path, surface: "Surface") -> None:
    """Writes polygons; the ending of the name tells the format. See Surface.save()."""
    check_surface_path(path)
    if os.path.splitext(os.fspath(path))[1].lower() == ".vtp":
        write_vtp(path, surface)
    else:
        write_stl(path, surface)


def write_vtp(path: Path, surface: "Surface") -> None:
    """Writes a VTP file, with all arrays and names."""
    arrays = [
        ("BoundaryLabels", surface.labels),
        ("StructuralFacetId", surface.facets),
        ("ContactId", surface.contact_ids),
    ]
    texts = [("ContactNames", surface.contact_names), ("RegionNames", surface.region_names)]
    polygons = [
        ("connectivity", np.asarray(surface.connectivity, np.int64)),
        ("offsets", np.asarray(surface.offsets[1:], np.int64)),
    ]
    sections = [
        ("CellData", [(name, values) for name, values in arrays if values is not None]),
        ("Points", [("Points", surface.points)]),
        ("Polys", polygons),
    ]
    head = f'NumberOfPolys="{len(surface.offsets) - 1}"'
    names = [(name, lines) for name, lines in texts if lines]
    _write_xml(path, "PolyData", head, surface.points, sections, names)


def write_stl(path: Path, surface: "Surface") -> None:
    """Writes a binary STL file: triangles in single precision, nothing else."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
    records = np.zeros(len(surface.triangles), record)
    records["corners"] = surface.points[surface.triangles]
    with open(path, "wb") as file:
        file.write(b"Triangles".ljust(80) + len(records).to_bytes(4, "little") + records.tobytes())


def _write_xml(
    path: Path,
    kind: str,
    numbers: str,
    points: np.ndarray,
    sections: Sequence[Tuple[str, Arrays]],
    texts: Sequence[Tuple[str, List[str]]],
) -> None:
    lines = [
        '<?xml version="1.0"?>',
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        f"<{kind}>",
        "<FieldData>",
        *(_text_array(name, lines) for name, lines in texts),
        "</FieldData>",
        f'<Piece NumberOfPoints="{len(points)}" {numbers}>',
    ]
    for section, arrays in sections:
        lines += [f"<{section}>", *(_data_array(*array) for array in arrays), f"</{section}>"]
    lines += ["</Piece>", f"</{kind}>", "</VTKFile>"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def _text_array(name: str, lines: Sequence[str]) -> str:
    values, pieces = encode(lines)
    return _data_array(name, np.array([values], np.int32), pieces)


def _data_array(name: str, values: Any, component_names: Sequence[str] = ()) -> str:
    kinds = {"f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}
    array = np.asarray(values)
    kind = array.dtype.str[1:]
    content = np.ascontiguousarray(array, "<" + kind).tobytes()
    components = array.shape[1] if array.ndim == 2 else 1
    encoded = base64.b64encode(len(content).to_bytes(8, "little") + content).decode()
    names = [f'ComponentName{i}="{text}" ' for i, text in enumerate(component_names)]
    # Of field data all rows count, of others those of the points or cells.
    rows = f'NumberOfTuples="{len(array)}" ' if component_names else ""
    return (
        f'<DataArray type="{kinds[kind]}" Name="{name}" NumberOfComponents="{components}" '
        f'{"".join(names)}{rows}format="binary">{encoded}</DataArray>'
    )
