# SPDX-License-Identifier: BSD-3-Clause
"""Gmsh's formats 2.2 and 4.1, with the physical groups of groups.py.

The files are those of vtkGmshMeshWriter: the same numbers, names and order, see its header. Reference: Gmsh
reference manual, "MSH file format" and "MSH file format version 2 (Legacy)".
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Iterable, List, TextIO, Union

import numpy as np

from .groups import PhysicalGroup, physical_groups

if TYPE_CHECKING:
    from .data import Mesh

FORMATS = ("2.2", "4.1")
_TRIANGLE, _TETRAHEDRON = 2, 4


class _Contents:
    """What both formats write: nodes and elements by number, and their groups."""

    def __init__(self, mesh: "Mesh", scale: float):
        self.groups = physical_groups(mesh, mesh.region_names, mesh.contacts)
        # Only points that are used, numbered from one in their order.
        self.used = np.unique(mesh.tetrahedra)
        numbers = np.zeros(len(mesh.points), np.int64)
        numbers[self.used] = np.arange(1, len(self.used) + 1)
        self.positions = mesh.points[self.used] * scale
        self.tetrahedra = numbers[mesh.tetrahedra]
        self.regions = np.asarray(mesh.regions)
        self.triangles = [numbers[group.triangles] for group in self.groups]
        self.number_of_facets = sum(map(len, self.triangles))

    def select(self, group: PhysicalGroup) -> np.ndarray:
        """Tetrahedra of the group of a region."""
        return np.flatnonzero(self.regions == group.regions[0])

    def box(self, i: int) -> np.ndarray:
        """The corners of the bounding box of a group, low and high."""
        group = self.groups[i]
        is_region = group.kind == "region"
        nodes = self.tetrahedra[self.select(group)] if is_region else self.triangles[i]
        positions = self.positions[nodes.reshape(-1) - 1]
        return np.concatenate([positions.min(axis=0), positions.max(axis=0)])


def _dimension(group: PhysicalGroup) -> int:
    return 3 if group.kind == "region" else 2


def _lines(rows: Iterable[List[float]]) -> str:
    """repr() reads back as the same number."""
    return "".join(" ".join(map(repr, row)) + "\n" for row in rows)


def check_options(gmsh_format: str, scale: float) -> None:
    """ValueError for another format, or a scale that is not above 0."""
    if str(gmsh_format) not in FORMATS:
        raise ValueError(f"gmsh_format is {gmsh_format!r}: it has to be one of {', '.join(FORMATS)}.")
    if not 0.0 < scale < float("inf"):
        raise ValueError(f"scale is {scale!r}: it has to be above 0, and finite.")


def write_msh(
    path: "Union[str, os.PathLike[str]]",
    mesh: "Mesh",
    *,
    gmsh_format: str = "2.2",
    scale: float = 1.0,
) -> None:
    """Writes a text file of Gmsh with a physical group for each region, interface, side and contact.

    Parameters
    ----------
    path : str or path
        Name of the file, usually *.msh.
    mesh : Mesh
        Its region_names and contacts name the groups.
    gmsh_format : {"2.2", "4.1"}
        Version of the format.
    scale : float
        Factor of the coordinates, above 0.

    Raises
    ------
    ValueError
        For another format or scale, or a mesh without tetrahedra.
    """
    check_options(gmsh_format, scale)
    if len(mesh.tetrahedra) == 0:
        raise ValueError("The mesh has no tetrahedra.")
    contents = _Contents(mesh, scale)
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"$MeshFormat\n{gmsh_format} 0 8\n$EndMeshFormat\n")
        file.write(f"$PhysicalNames\n{len(contents.groups)}\n")
        for group in contents.groups:
            file.write(f'{_dimension(group)} {group.number} "{group.name}"\n')
        file.write("$EndPhysicalNames\n")
        if str(gmsh_format) == "2.2":
            _write_version_2(file, contents)
        else:
            _write_version_4(file, contents)


def _write_version_2(file: TextIO, contents: _Contents) -> None:
    file.write(f"$Nodes\n{len(contents.used)}\n")
    for number, position in enumerate(contents.positions.tolist(), 1):
        file.write(f"{number} " + _lines([position]))
    count = contents.number_of_facets + len(contents.tetrahedra)
    file.write(f"$EndNodes\n$Elements\n{count}\n")

    def write(first: int, kind: int, groups: np.ndarray, nodes: np.ndarray) -> None:
        columns = [np.arange(first, first + len(nodes)), np.full(len(nodes), kind)]
        columns += [np.full(len(nodes), 2), groups, groups]
        file.write(_lines(np.concatenate([np.stack(columns, axis=1), nodes], axis=1).tolist()))

    first = 1
    for group, triangles in zip(contents.groups, contents.triangles):
        write(first, _TRIANGLE, np.full(len(triangles), group.number), triangles)
        first += len(triangles)
    write(first, _TETRAHEDRON, contents.regions + 1, contents.tetrahedra)
    file.write("$EndElements\n")


def _write_version_4(file: TextIO, contents: _Contents) -> None:
    regions = [group for group in contents.groups if group.kind == "region"]
    surfaces = len(contents.groups) - len(regions)
    file.write(f"$Entities\n0 0 {surfaces} {len(regions)}\n")
    for dimension in (2, 3):
        for i, group in enumerate(contents.groups):
            if _dimension(group) == dimension:
                box = " ".join(map(repr, contents.box(i).tolist()))
                # One physical group; what bounds the entity is not said.
                file.write(f"{group.number} {box} 1 {group.number} 0\n")
    file.write("$EndEntities\n")

    # A node belongs to the lowest of its regions.
    owners = np.full(len(contents.used) + 1, np.iinfo(np.int64).max)
    np.minimum.at(owners, contents.tetrahedra, contents.regions[:, np.newaxis].astype(np.int64))
    owners[0] = -1
    blocks = [(group, np.flatnonzero(owners == group.regions[0])) for group in regions]
    blocks = [(group, nodes) for group, nodes in blocks if len(nodes)]
    number = len(contents.used)
    file.write(f"$Nodes\n{len(blocks)} {number} 1 {number}\n")
    for group, nodes in blocks:
        file.write(f"3 {group.number} 0 {len(nodes)}\n")
        file.write(_lines(nodes.reshape(-1, 1).tolist()))
        file.write(_lines(contents.positions[nodes - 1].tolist()))
    count = contents.number_of_facets + len(contents.tetrahedra)
    file.write(f"$EndNodes\n$Elements\n{len(contents.groups)} {count} 1 {count}\n")
    first = 1

    def write(group: PhysicalGroup, kind: int, numbers: np.ndarray, nodes: np.ndarray) -> None:
        file.write(f"{_dimension(group)} {group.number} {kind} {len(nodes)}\n")
        file.write(_lines(np.concatenate([numbers[:, np.newaxis], nodes], axis=1).tolist()))

    for group, triangles in zip(contents.groups, contents.triangles):
        if group.kind != "region":
            write(group, _TRIANGLE, np.arange(first, first + len(triangles)), triangles)
            first += len(triangles)
    for group in regions:
        chosen = contents.select(group)
        write(group, _TETRAHEDRON, first + chosen, contents.tetrahedra[chosen])
    file.write("$EndElements\n")
