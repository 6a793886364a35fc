# SPDX-License-Identifier: BSD-3-Clause
"""The accessor `delaunay` of PyVista's data sets, with PyVista 0.48 and later.

    import pyvista

    mesh = pyvista.Sphere().delaunay.mesh(edge_length=0.1)
    mesh.grid.plot(show_edges=True)

PyVista finds it by itself where the wheel is installed (entry point pyvista.accessors); elsewhere import this
module.
"""

from __future__ import annotations

from typing import Any

import pyvista

from .data import Certificate, Mesh, Surface
from .meshing import ControlVolumes, certify, control_volumes, extract_interfaces, mesh


@pyvista.register_dataset_accessor("delaunay", pyvista.PolyData)
class SurfaceAccessor:
    """What this package does with polygons."""

    def __init__(self, surface: "pyvista.PolyData"):
        self._surface = surface

    def mesh(self, **options: Any) -> Mesh:
        """conforming_delaunay.mesh() of these polygons, with its options."""
        return mesh(Surface.from_pyvista(self._surface), **options)


@pyvista.register_dataset_accessor("delaunay", pyvista.UnstructuredGrid)
class GridAccessor:
    """What this package does with tetrahedra."""

    def __init__(self, grid: "pyvista.UnstructuredGrid"):
        self._grid = grid

    def certify(self, **options: Any) -> Certificate:
        """conforming_delaunay.certify() of these tetrahedra."""
        return certify(Mesh.from_pyvista(self._grid), **options)

    def control_volumes(self, **options: Any) -> ControlVolumes:
        """conforming_delaunay.control_volumes() of these tetrahedra."""
        return control_volumes(Mesh.from_pyvista(self._grid), **options)


@pyvista.register_dataset_accessor("delaunay", pyvista.ImageData)
class VoxelAccessor:
    """What this package does with labelled voxels."""

    def __init__(self, image: "pyvista.ImageData"):
        self._image = image

    def extract_interfaces(self, **options: Any) -> "pyvista.PolyData":
        """conforming_delaunay.extract_interfaces() of these voxels, with its options."""
        return extract_interfaces(self._image, **options).to_pyvista()
