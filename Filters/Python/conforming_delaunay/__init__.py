# SPDX-License-Identifier: BSD-3-Clause
"""Boundary-conforming Delaunay tetrahedral meshes of surfaces and of structures of many materials.

    import conforming_delaunay as cd

    mesh = cd.mesh("part.stl", edge_length=2.0)
    print(mesh.certificate)
    mesh.save("part.vtu")
    mesh.save("part.msh")

All stages
    mesh() -> Mesh: points, tetrahedra, regions, boundary, contacts, certificate, grid, save().
    Options may be words: PURPOSES, CRITERIA, PLACEMENTS, TEMPLATES.

What goes in and comes out
    Surface: polygons, of files, NumPy arrays, VTK or PyVista. Mesh: tetrahedra, of files or PyVista.
    extract_interfaces(): a Surface from labelled voxels. get_texts(): names in field data.
    Certificate: what a mesh is worth; FAULTS: what can be wrong. ControlVolumes: for a solver.

Each stage by itself
    triangulate_boundary() -> Surface, Problems; extract_structural_edges() -> StructuralEdges;
    refine_surface(); generate_mesh_points(); tetrahedralize(); remove_slivers(); refine_mesh();
    certify(); control_volumes().

Errors
    MeshingError, with the cells and points that are at fault; OptionError, which is a ValueError, too;
    Aborted. ErrorCode: what went wrong. MeshingWarning: something was not done as asked.

Modules
    devsim: devices of the simulator DEVSIM. gmsh, groups: Gmsh's files and their physical groups.
    pyvista_accessor: dataset.delaunay of PyVista 0.48 and later. The command line is in __main__:
    conforming-delaunay --help.

All this needs NumPy only, and takes and gives VTK's data sets where VTK is installed. For pipelines of VTK
there are filters under the names of the C++ classes, such as vtkConformingDelaunayMesher: the wrapped
classes in ParaView and in Debian's packages, filters in Python, for VTK 9.1 and later, in the wheel. They
make the same meshes.
"""

from __future__ import annotations

from typing import Any, List

from ._engine import Aborted, ErrorCode, MeshingError, OptionError
from ._engine import version as __version__
from .data import FAULTS, Certificate, Mesh, Surface
from .meshing import (
    CRITERIA,
    PLACEMENTS,
    PURPOSES,
    TEMPLATES,
    ControlVolumes,
    MeshingWarning,
    Problems,
    StructuralEdges,
    certify,
    control_volumes,
    extract_interfaces,
    extract_structural_edges,
    generate_mesh_points,
    mesh,
    refine_mesh,
    refine_surface,
    remove_slivers,
    tetrahedralize,
    triangulate_boundary,
)
from .texts import get_texts

try:
    from .cdmMeshing import *  # type: ignore # noqa: F401,F403
except ImportError as _error:
    if getattr(_error, "name", "") != __name__ + ".cdmMeshing":
        raise

    def __getattr__(name: str) -> Any:
        if name.startswith("vtk"):
            from . import filters

            if name in filters.__all__:
                return getattr(filters, name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "Aborted",
    "CRITERIA",
    "Certificate",
    "ControlVolumes",
    "ErrorCode",
    "FAULTS",
    "Mesh",
    "MeshingError",
    "MeshingWarning",
    "OptionError",
    "PLACEMENTS",
    "PURPOSES",
    "Problems",
    "StructuralEdges",
    "Surface",
    "TEMPLATES",
    "__version__",
    "certify",
    "control_volumes",
    "extract_interfaces",
    "extract_structural_edges",
    "generate_mesh_points",
    "get_texts",
    "mesh",
    "refine_mesh",
    "refine_surface",
    "remove_slivers",
    "tetrahedralize",
    "triangulate_boundary",
]
__all__ += [name for name in globals() if name.startswith("vtk")]


def __dir__() -> List[str]:
    return sorted(name for name in globals() if not name.startswith("_"))
