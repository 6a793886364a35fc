# SPDX-License-Identifier: BSD-3-Clause
"""Boundary-conforming Delaunay tetrahedral meshes of surfaces and of structures of many materials.

    import conforming_delaunay as cd

    mesh = cd.mesh("part.stl", maximum_edge_length=2.0, add_steiner_points=True)
    print(mesh.certificate)
    mesh.save("part.vtu")

mesh() runs all stages; each of them is a function, too: triangulate_boundary(),
extract_structural_edges(), refine_surface(), generate_mesh_points(), tetrahedralize(),
remove_slivers(), refine_mesh(), certify(), control_volumes(). They need NumPy only, and take and
give VTK's data sets where VTK is installed.

For pipelines of VTK there are filters under the names of the C++ classes, such as
vtkConformingDelaunayMesher: the wrapped classes in ParaView and in Debian's packages, filters in
Python, for VTK 9.1 and later, in the wheel. They make the same meshes.
"""

from __future__ import annotations

from typing import Any, List

from ._engine import Aborted, ErrorCode, MeshingError, OptionError
from ._engine import version as __version__
from .data import FAULTS, Certificate, Mesh, Surface
from .meshing import (
    CRITERIA,
    PLACEMENTS,
    TEMPLATES,
    ControlVolumes,
    MeshingWarning,
    Problems,
    StructuralEdges,
    certify,
    control_volumes,
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


def __dir__() -> List[str]:
    return sorted(name for name in globals() if not name.startswith("_"))
